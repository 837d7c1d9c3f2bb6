#include "joined_head.h"

#include <algorithm>

#include "bspc/error.h"

namespace bspc {

namespace {

[[noreturn]] void refuse(std::size_t file, const std::string& reason) {
  throw Error(ErrorCode::InvalidArgument, "file " + std::to_string(file) + " " + reason);
}

const ArrayDescription* find(const std::vector<ArrayDescription>& arrays, const std::string& name) {
  const auto found = std::find_if(arrays.begin(), arrays.end(),
                                  [&name](const ArrayDescription& a) { return a.name == name; });
  return found == arrays.end() ? nullptr : &*found;
}

std::string shapeOf(const ArrayDescription& array) {
  return std::to_string(array.components) + " x " + scalarName(array.type);
}

void requireEqual(std::size_t file, const ArrayDescription& before, const ArrayDescription& array) {
  if (array.type != before.type || array.components != before.components ||
      array.semantic != before.semantic) {
    refuse(file, "has the array \"" + array.name + "\" as " + shapeOf(array) +
                     ", and those before it as " + shapeOf(before) +
                     (array.semantic != before.semantic ? " of another meaning" : "") +
                     "; encode it anew with arrays of one type");
  }
  if (array.unit != before.unit || array.componentNames != before.componentNames) {
    refuse(file, "has the array \"" + array.name +
                     "\" in another unit or with other component names than those before it; "
                     "encode it anew with the same");
  }
}

/// Takes the text of the first file that has one.
void takeText(std::size_t file, const char* what, const std::string& text, std::string& joined) {
  if (text.empty() || text == joined) return;
  if (!joined.empty()) {
    refuse(file, std::string("has the ") + what + " \"" + text + "\", and those before it have \"" +
                     joined + "\"; bring the coordinates to one of them first");
  }
  joined = text;
}

bool equal(const ArrayValues& a, const ArrayValues& b) {
  return a.type == b.type && a.components == b.components && a.values == b.values &&
         a.strings == b.strings;
}

}  // namespace

void JoinedTables::take(std::size_t file, const container::FileHead& head) {
  keepsOrder_ = keepsOrder_ && head.keepsOrder;
  if (!any_) {
    arrays_ = head.arrays;
    any_ = true;
  }
  for (const ArrayDescription& array : head.arrays) {
    if (find(arrays_, array.name) == nullptr) {
      refuse(file, "has the array \"" + array.name +
                       "\", which those before it have not; encode all with the same arrays");
    }
  }
  indices_.resize(std::max(indices_.size(), file + 1));
  for (ArrayDescription& array : arrays_) {
    const ArrayDescription* same = find(head.arrays, array.name);
    if (same == nullptr) {
      refuse(file, "has no array \"" + array.name +
                       "\", which those before it have; encode all with the same arrays");
    }
    requireEqual(file, array, *same);
    array.tolerance = std::max(array.tolerance, same->tolerance);
    indices_[file].push_back(static_cast<std::size_t>(same - head.arrays.data()));
  }
}

void JoinedMeshes::take(std::size_t file, std::uint64_t firstTile,
                        const container::MeshRecord& mesh) {
  if (mesh.blocks == 0) return;
  if (sources_.empty()) record_.arrays = mesh.arrays;
  if (mesh.arrays.size() != record_.arrays.size()) {
    refuse(file, "has other arrays of cells than those before it; encode all with the same");
  }
  for (std::size_t a = 0; a < mesh.arrays.size(); ++a) {
    if (mesh.arrays[a].name != record_.arrays[a].name) {
      refuse(file, "has the array of cells \"" + mesh.arrays[a].name +
                       "\" where those before it have \"" + record_.arrays[a].name +
                       "\"; encode all with the same arrays in the same order");
    }
    requireEqual(file, record_.arrays[a], mesh.arrays[a]);
    record_.arrays[a].tolerance = std::max(record_.arrays[a].tolerance, mesh.arrays[a].tolerance);
  }
  record_.counts.add(mesh.counts);
  record_.blocks += mesh.blocks;
  for (std::size_t b = 0; b < mesh.blocks; ++b) sources_.push_back({file, b, firstTile});
}

void JoinedMetadata::take(std::size_t file, const Metadata& metadata) {
  takeText(file, "coordinate reference system", metadata.crs, metadata_.crs);
  takeText(file, "length unit", metadata.lengthUnit, metadata_.lengthUnit);
  for (const auto& entry : metadata.entries) {
    const auto same = std::find_if(metadata_.entries.begin(), metadata_.entries.end(),
                                   [&](const auto& e) { return e.first == entry.first; });
    if (same == metadata_.entries.end()) {
      metadata_.entries.push_back(entry);
    } else if (same->second != entry.second) {
      dropped_.push_back("file " + std::to_string(file) + ": " + entry.first);
    }
  }
  for (const ArrayValues& array : metadata.fieldData) {
    const auto same = std::find_if(metadata_.fieldData.begin(), metadata_.fieldData.end(),
                                   [&](const ArrayValues& a) { return a.name == array.name; });
    if (same == metadata_.fieldData.end()) {
      metadata_.fieldData.push_back(array);
    } else if (!equal(*same, array)) {
      dropped_.push_back("file " + std::to_string(file) + ": " + array.name);
    }
  }
}

}  // namespace bspc
