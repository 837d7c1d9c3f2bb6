#include "formats/array_tuples.h"

#include <string>

namespace bspc::formats {

std::uint8_t* appendTuples(ArrayValues& array, std::size_t count) {
  const std::size_t before = array.values.size();
  array.values.resize(before + count * array.components * arrayValueSize(array.type));
  return array.values.data() + before;
}

void appendTuple(Span<ArrayValues> arrays) {
  for (ArrayValues& array : arrays) {
    if (array.type == ScalarType::String) {
      array.strings.resize(array.strings.size() + array.components);
    } else {
      appendTuples(array, 1);
    }
  }
}

std::vector<ColumnTarget> targetsOf(const std::vector<GroupedColumns>& groups,
                                    std::size_t columns) {
  std::vector<ColumnTarget> targets(columns);
  for (std::size_t a = 0; a < groups.size(); ++a) {
    const std::vector<std::size_t>& members = groups[a].columns;
    for (std::size_t k = 0; k < members.size(); ++k) {
      targets[members[k]] = {a, (members.size() - k) * arrayValueSize(groups[a].array.type)};
    }
  }
  return targets;
}

std::vector<ArrayDescription> arraysOf(const std::vector<GroupedColumns>& groups) {
  std::vector<ArrayDescription> arrays;
  arrays.reserve(groups.size());
  for (const GroupedColumns& group : groups) arrays.push_back(group.array);
  return arrays;
}

std::vector<ArrayValues> emptyArrays(const std::vector<ArrayDescription>& descriptions) {
  std::vector<ArrayValues> arrays(descriptions.size());
  for (std::size_t a = 0; a < arrays.size(); ++a) {
    static_cast<ArrayDescription&>(arrays[a]) = descriptions[a];
  }
  return arrays;
}

}  // namespace bspc::formats
