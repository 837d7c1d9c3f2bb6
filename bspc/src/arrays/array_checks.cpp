#include "arrays/array_checks.h"

#include <cmath>
#include <set>
#include <string>

#include "arrays/array_source.h"
#include "bspc/error.h"
#include "container/array_table.h"

namespace bspc {

namespace {

[[noreturn]] void refuse(const ArrayDescription& array, const std::string& reason) {
  throw Error(ErrorCode::InvalidArgument, "the array \"" + array.name + "\" " + reason);
}

/// A set of names in which each may come once.
class UniqueNames {
 public:
  void add(const ArrayDescription& array) {
    if (!names_.insert(array.name).second) {
      refuse(array, "comes twice; names of arrays are unique, so rename one");
    }
  }

 private:
  std::set<std::string> names_;
};

void checkView(const ArrayView& array, std::uint64_t points, const char* owner) {
  checkDescription(array);
  if (array.tuples != points) {
    refuse(array, "has " + std::to_string(array.tuples) + " tuples for " + std::to_string(points) +
                      " " + owner + "s; give one tuple a " + owner);
  }
  const std::size_t packed = array.components * arrayValueSize(array.type);
  if (array.strideBytes != 0 && array.strideBytes < packed) {
    refuse(array, "has tuples " + std::to_string(array.strideBytes) + " bytes apart that take " +
                      std::to_string(packed) + "; give a stride at least that large, or 0");
  }
  if (array.data == nullptr && points > 0) {
    refuse(array, "is at a null address; pass its values");
  }
}

}  // namespace

void checkDescription(const ArrayDescription& array) {
  if (array.name.empty()) {
    throw Error(ErrorCode::InvalidArgument, "an array has no name; name it");
  }
  if (array.type > ScalarType::String) refuse(array, "is of an unknown type");
  if (array.components == 0 || array.components > container::kMaxComponents) {
    refuse(array, "has " + std::to_string(array.components) + " components; 1 to " +
                      std::to_string(container::kMaxComponents) + " are possible");
  }
  if (!array.componentNames.empty() && array.componentNames.size() != array.components) {
    refuse(array, "has " + std::to_string(array.componentNames.size()) + " component names for " +
                      std::to_string(array.components) + " components; name all or none");
  }
  if (!std::isfinite(array.tolerance) || array.tolerance < 0) {
    refuse(array, "has a tolerance that is not a finite number from 0 on");
  }
  if (array.tolerance > 0 && !isFloatingPoint(array.type)) {
    refuse(array, std::string("is of type ") + scalarName(array.type) +
                      ", and only floating-point arrays can have a tolerance; leave it out");
  }
}

void checkArrays(Span<const ArrayView> arrays, std::uint64_t points, const EncodeOptions& options) {
  UniqueNames names;
  for (const ArrayView& array : arrays) {
    checkView(array, points, "point");
    names.add(array);
  }
  if (options.originalIds) names.add(originalIdsDescription());
}

void checkCellArrays(Span<const ArrayView> arrays, std::uint64_t cells) {
  UniqueNames names;
  for (const ArrayView& array : arrays) {
    checkView(array, cells, "cell");
    names.add(array);
  }
}

void checkDescriptions(const std::vector<ArrayDescription>& arrays, const EncodeOptions& options) {
  UniqueNames names;
  for (const ArrayDescription& array : arrays) {
    checkDescription(array);
    names.add(array);
  }
  if (options.originalIds) names.add(originalIdsDescription());
}

void checkMetadata(const Metadata& metadata) {
  std::set<std::string> keys;
  for (const auto& entry : metadata.entries) {
    if (!keys.insert(entry.first).second) {
      throw Error(ErrorCode::InvalidArgument,
                  "the metadata has the key \"" + entry.first + "\" twice; keys are unique");
    }
  }
  UniqueNames names;
  for (const ArrayValues& array : metadata.fieldData) {
    checkDescription(array);
    names.add(array);
    const bool strings = array.type == ScalarType::String;
    const std::size_t tuple =
        strings ? array.components : array.components * arrayValueSize(array.type);
    if ((strings ? array.strings.size() : array.values.size()) % tuple != 0) {
      refuse(array, "ends inside a tuple; give whole tuples");
    }
  }
}

}  // namespace bspc
