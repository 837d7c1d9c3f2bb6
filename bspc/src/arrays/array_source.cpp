#include "arrays/array_source.h"

#include <cstring>

namespace bspc {

namespace {

attributes::ArrayValues gatherStrings(const ArrayView& array,
                                      const std::vector<std::uint64_t>& sources) {
  attributes::ArrayValues values;
  values.strings.reserve(sources.size() * array.components);
  const std::size_t stride =
      array.strideBytes != 0 ? array.strideBytes : array.components * sizeof(std::string);
  const auto* data = static_cast<const std::uint8_t*>(array.data);
  for (const std::uint64_t source : sources) {
    const auto* tuple = reinterpret_cast<const std::string*>(data + source * stride);
    values.strings.insert(values.strings.end(), tuple, tuple + array.components);
  }
  return values;
}

attributes::ArrayValues gatherNumbers(const ArrayView& array,
                                      const std::vector<std::uint64_t>& sources) {
  attributes::ArrayValues values;
  const std::size_t bytes = array.components * arrayValueSize(array.type);
  const std::size_t stride = array.strideBytes != 0 ? array.strideBytes : bytes;
  const auto* data = static_cast<const std::uint8_t*>(array.data);
  values.numbers.resize(sources.size() * bytes);
  std::uint8_t* to = values.numbers.data();
  for (const std::uint64_t source : sources) {
    std::memcpy(to, data + source * stride, bytes);
    to += bytes;
  }
  if (array.type == ScalarType::Bit) {
    for (std::uint8_t& bit : values.numbers) bit = bit != 0 ? 1 : 0;
  }
  return values;
}

}  // namespace

ArrayDescription originalIdsDescription() {
  ArrayDescription ids;
  ids.name = "OriginalPointIds";
  ids.type = ScalarType::UInt64;
  ids.semantic = Semantic::Ids;
  return ids;
}

ArrayDescription ArraySource::description(std::size_t array) const {
  if (array >= arrays_.size()) return originalIdsDescription();
  return static_cast<const ArrayDescription&>(arrays_[array]);
}

attributes::ArrayShape ArraySource::shape(std::size_t array) const {
  const ArrayDescription what = description(array);
  return {what.type, what.components, what.semantic};
}

attributes::ArrayValues ArraySource::gather(std::size_t array,
                                            const std::vector<std::uint64_t>& sources) const {
  if (array < arrays_.size()) {
    const ArrayView& view = arrays_[array];
    return view.type == ScalarType::String ? gatherStrings(view, sources)
                                           : gatherNumbers(view, sources);
  }
  attributes::ArrayValues ids;
  ids.numbers.resize(sources.size() * sizeof(std::uint64_t));
  if (!sources.empty()) std::memcpy(ids.numbers.data(), sources.data(), ids.numbers.size());
  return ids;
}

}  // namespace bspc
