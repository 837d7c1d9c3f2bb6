#include "formats/array_columns.h"

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <set>
#include <string_view>
#include <utility>

#include "formats/model.h"
#include "formats/wording.h"

namespace bspc::formats {

namespace {

/// Columns that belong together, by the names that programs give them.
struct KnownGroup {
  const char* array;
  Semantic semantic;
  std::size_t components;
  std::array<const char*, 4> names;
};

/// The first of each meaning and size is what columnsOf() falls back to.
constexpr std::array<KnownGroup, 12> kKnownGroups{{
    {"Normals", Semantic::Normals, 3, {"nx", "ny", "nz", nullptr}},
    {"Normals", Semantic::Normals, 3, {"normal_x", "normal_y", "normal_z", nullptr}},
    {"RGBA", Semantic::Colours, 4, {"red", "green", "blue", "alpha"}},
    {"RGB", Semantic::Colours, 3, {"red", "green", "blue", nullptr}},
    {"RGBA", Semantic::Colours, 4, {"diffuse_red", "diffuse_green", "diffuse_blue", "alpha"}},
    {"RGB", Semantic::Colours, 3, {"diffuse_red", "diffuse_green", "diffuse_blue", nullptr}},
    {"RGBA", Semantic::Colours, 4, {"r", "g", "b", "a"}},
    {"RGB", Semantic::Colours, 3, {"r", "g", "b", nullptr}},
    {"RGB", Semantic::Colours, 3, {"R", "G", "B", nullptr}},
    {"TextureCoordinates", Semantic::TextureCoordinates, 2, {"u", "v", nullptr, nullptr}},
    {"TextureCoordinates", Semantic::TextureCoordinates, 2, {"s", "t", nullptr, nullptr}},
    {"TextureCoordinates",
     Semantic::TextureCoordinates,
     2,
     {"texture_u", "texture_v", nullptr, nullptr}},
}};

std::vector<std::string> namesOf(const KnownGroup& group) {
  return {group.names.begin(), group.names.begin() + group.components};
}

class Grouper {
 public:
  explicit Grouper(const std::vector<Column>& columns) : columns_(columns) {
    for (std::size_t c = 0; c < columns.size(); ++c) columnOf_.emplace(columns[c].name, c);
  }

  std::vector<GroupedColumns> group() {
    for (const KnownGroup& known : kKnownGroups) takeKnown(known);
    for (std::size_t c = 0; c < columns_.size(); ++c) {
      if (!isUsed(c)) takeNumbered(c);
    }
    for (std::size_t c = 0; c < columns_.size(); ++c) {
      if (!isUsed(c)) take({c}, columns_[c].name);
    }
    std::sort(groups_.begin(), groups_.end(), [](const auto& a, const auto& b) {
      return *std::min_element(a.columns.begin(), a.columns.end()) <
             *std::min_element(b.columns.begin(), b.columns.end());
    });
    return std::move(groups_);
  }

 private:
  bool isUsed(std::size_t column) const { return used_.count(column) > 0; }

  /// The unused column of this name, if its type fits those before it.
  std::optional<std::size_t> find(const std::string& name,
                                  const std::vector<std::size_t>& before) const {
    const auto found = columnOf_.find(name);
    if (found == columnOf_.end() || isUsed(found->second)) return std::nullopt;
    const ScalarType type = columns_[found->second].type;
    if (!before.empty() && columns_[before.front()].type != type) return std::nullopt;
    return found->second;
  }

  GroupedColumns& take(std::vector<std::size_t> members, const std::string& name) {
    used_.insert(members.begin(), members.end());
    GroupedColumns group;
    group.array.name = name;
    group.array.type = columns_[members.front()].type;
    group.array.components = static_cast<std::uint32_t>(members.size());
    group.columns = std::move(members);
    groups_.push_back(std::move(group));
    return groups_.back();
  }

  /// Whether a column or a group has this name.
  bool isTaken(const std::string& name) const {
    return columnOf_.count(name) > 0 || groupNames_.count(name) > 0;
  }

  void takeKnown(const KnownGroup& known) {
    std::vector<std::size_t> members;
    for (const std::string& name : namesOf(known)) {
      const std::optional<std::size_t> column = find(name, members);
      if (!column) return;
      members.push_back(*column);
    }
    const ScalarType type = columns_[members.front()].type;
    const bool isMeant = known.semantic == Semantic::Colours
                             ? type != ScalarType::Bit && type != ScalarType::String
                             : isFloatingPoint(type);
    if (!isMeant || isTaken(known.array)) return;
    groupNames_.insert(known.array);
    GroupedColumns& group = take(std::move(members), known.array);
    group.array.semantic = known.semantic;
    group.array.componentNames = namesOf(known);
  }

  /// "name:0" with those that follow it.
  void takeNumbered(std::size_t first) {
    const std::string& name = columns_[first].name;
    if (name.size() < 3 || name.substr(name.size() - 2) != ":0") return;
    const std::string stem = name.substr(0, name.size() - 2);
    std::vector<std::size_t> members{first};
    while (const auto next = find(stem + ":" + std::to_string(members.size()), members)) {
      members.push_back(*next);
    }
    if (members.size() < 2 || isTaken(stem)) return;
    groupNames_.insert(stem);
    take(std::move(members), stem);
  }

  const std::vector<Column>& columns_;
  std::map<std::string, std::size_t> columnOf_;
  std::set<std::size_t> used_;
  std::set<std::string> groupNames_;
  std::vector<GroupedColumns> groups_;
};

std::vector<std::string> numberedNames(const ArrayDescription& array) {
  if (array.components == 1) return {array.name};
  std::vector<std::string> names;
  names.reserve(array.components);
  for (std::uint32_t k = 0; k < array.components; ++k) {
    names.push_back(array.name + ":" + std::to_string(k));
  }
  return names;
}

/// Whether these names are free, which they are no more after that.
bool claim(const std::vector<std::string>& names, std::set<std::string>& taken) {
  const auto isTaken = [&](const std::string& name) { return taken.count(name) > 0; };
  if (std::any_of(names.begin(), names.end(), isTaken)) return false;
  taken.insert(names.begin(), names.end());
  return true;
}

}  // namespace

std::vector<GroupedColumns> groupColumns(const std::vector<Column>& columns) {
  return Grouper(columns).group();
}

std::vector<ArrayColumn> columnsOf(const std::vector<ArrayDescription>& arrays) {
  std::set<std::string> taken{"x", "y", "z"};
  std::vector<std::vector<std::string>> names(arrays.size());
  // Arrays of one number first: their names are their own, which those of components give way to.
  for (const bool scalars : {true, false}) {
    for (std::size_t a = 0; a < arrays.size(); ++a) {
      const ArrayDescription& array = arrays[a];
      if ((array.components == 1) != scalars) continue;
      names[a] = namesOfComponents(array);
      if (!names[a].empty() && claim(names[a], taken)) continue;
      names[a] = numberedNames(array);
      if (claim(names[a], taken)) continue;
      throw FormatError("the array " + quoted(array.name) +
                        " gets the name of another column of the file; leave one of them out");
    }
  }
  std::vector<ArrayColumn> columns;
  for (std::size_t a = 0; a < arrays.size(); ++a) {
    const ScalarType type = arrays[a].type == ScalarType::Bit ? ScalarType::UInt8 : arrays[a].type;
    for (std::size_t k = 0; k < names[a].size(); ++k) {
      columns.push_back({{names[a][k], type}, a, k});
    }
  }
  return columns;
}

std::vector<std::string> namesOfComponents(const ArrayDescription& array) {
  std::vector<std::string> names;
  for (const KnownGroup& known : kKnownGroups) {
    if (known.semantic != array.semantic || known.components != array.components) continue;
    if (namesOf(known) == array.componentNames) return array.componentNames;
    if (names.empty()) names = namesOf(known);
  }
  return names;
}

std::string wordOf(const std::string& name) {
  std::string word = name;
  for (char& c : word) {
    const auto code = static_cast<unsigned char>(c);
    if (code <= ' ' || code == 127) c = '_';
  }
  return word;
}

std::string uniqueName(const std::string& name, const std::set<std::string>& taken) {
  std::string unique = name;
  for (std::size_t number = 2; taken.count(unique) > 0; ++number) {
    unique = name + "_" + std::to_string(number);
  }
  return unique;
}

}  // namespace bspc::formats
