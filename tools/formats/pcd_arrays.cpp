#include "formats/pcd_arrays.h"

#include <algorithm>
#include <set>
#include <utility>

#include "formats/array_columns.h"
#include "formats/pcd_header.h"
#include "formats/wording.h"

namespace bspc::formats {

namespace {

bool isPosition(const PcdField& field) {
  return field.name == "x" || field.name == "y" || field.name == "z";
}

/// Colours go back into one number, so only those that came out of one are a group; normals get the
/// names of components that other formats know.
void takeGroup(std::vector<PcdArray>& arrays, const GroupedColumns& group,
               const std::vector<std::size_t>& fieldOf) {
  const bool isColour = group.array.semantic == Semantic::Colours;
  const bool isForeign =
      group.array.semantic == Semantic::Normals && group.array.componentNames[0] != "normal_x";
  PcdArray whole{group.array, {}, {}};
  for (std::size_t k = 0; k < group.columns.size(); ++k) {
    const std::size_t field = fieldOf[group.columns[k]];
    whole.fields.push_back(field);
    whole.offsets.push_back(0);
    if (!isColour && !isForeign) continue;
    PcdArray single;
    single.array.name = group.array.componentNames[k];
    single.array.type = group.array.type;
    single.fields = {field};
    single.offsets = {0};
    arrays.push_back(std::move(single));
  }
  if (isColour || isForeign) return;
  if (whole.array.semantic == Semantic::Normals) whole.array.componentNames = {"nx", "ny", "nz"};
  arrays.push_back(std::move(whole));
}

void takePackedColour(std::vector<PcdArray>& arrays, std::size_t field, bool hasAlpha,
                      const std::set<std::string>& taken) {
  PcdArray colours;
  colours.array.name = uniqueName(hasAlpha ? "RGBA" : "RGB", taken);
  colours.array.type = ScalarType::UInt8;
  colours.array.semantic = Semantic::Colours;
  colours.array.componentNames = {"red", "green", "blue"};
  colours.offsets = {2, 1, 0};
  if (hasAlpha) {
    colours.array.componentNames.emplace_back("alpha");
    colours.offsets.push_back(3);
  }
  colours.array.components = static_cast<std::uint32_t>(colours.offsets.size());
  colours.fields.assign(colours.offsets.size(), field);
  arrays.push_back(std::move(colours));
  if (hasAlpha) return;
  PcdArray padding;
  padding.array.name = uniqueName(kPcdColourPadding, taken);
  padding.array.type = ScalarType::UInt8;
  padding.fields = {field};
  padding.offsets = {3};
  arrays.push_back(std::move(padding));
}

void takeLongField(std::vector<PcdArray>& arrays, std::size_t index, const PcdField& field) {
  PcdArray all;
  all.array.name = utf8(field.name);
  all.array.type = field.type;
  all.array.components = static_cast<std::uint32_t>(field.count);
  for (std::size_t k = 0; k < field.count; ++k) {
    all.fields.push_back(index);
    all.offsets.push_back(k * scalarSize(field.type));
  }
  arrays.push_back(std::move(all));
}

}  // namespace

bool isPackedColour(const PcdField& field) {
  return (field.name == "rgb" || field.name == "rgba") && field.count == 1 &&
         scalarSize(field.type) == 4;
}

std::vector<PcdArray> pcdArrays(const std::vector<PcdField>& fields) {
  std::vector<PcdArray> arrays;
  std::vector<Column> columns;
  std::vector<std::size_t> fieldOf;
  std::set<std::string> taken;
  for (std::size_t i = 0; i < fields.size(); ++i) {
    const PcdField& field = fields[i];
    taken.insert(field.name);
    // Padding is called "_".
    if (isPosition(field) || field.name == "_" || field.count == 0) continue;
    if (isPackedColour(field)) continue;
    if (field.count > 1) {
      takeLongField(arrays, i, field);
    } else {
      columns.push_back({utf8(field.name), field.type});
      fieldOf.push_back(i);
    }
  }
  for (const GroupedColumns& group : groupColumns(columns)) {
    takeGroup(arrays, group, fieldOf);
    taken.insert(group.array.name);
  }
  for (std::size_t i = 0; i < fields.size(); ++i) {
    if (isPackedColour(fields[i])) takePackedColour(arrays, i, fields[i].name == "rgba", taken);
  }
  std::stable_sort(arrays.begin(), arrays.end(), [](const PcdArray& a, const PcdArray& b) {
    return a.fields.front() < b.fields.front();
  });
  return arrays;
}

}  // namespace bspc::formats
