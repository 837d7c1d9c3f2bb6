#include "streaming/record_layout.h"

#include <cstring>

#include "arrays/array_source.h"
#include "bspc/error.h"

namespace bspc::streaming {

RecordLayout::RecordLayout(const std::vector<ArrayDescription>& arrays, bool originalIds)
    : arrays_(arrays), originalIds_(originalIds) {
  if (originalIds_) arrays_.push_back(originalIdsDescription());
  for (const ArrayDescription& array : arrays_) {
    if (array.type == ScalarType::String) {
      throw Error(ErrorCode::Unsupported,
                  "the array \"" + array.name +
                      "\" is of strings, which can be stored only of sets that fit into memory; "
                      "raise the memory limit, or leave the array out");
    }
    sizes_.push_back(array.components * arrayValueSize(array.type));
    bytes_ += sizes_.back();
  }
}

Bytes RecordLayout::pack(Span<const ArrayValues> values, std::size_t firstTuple,
                         const std::vector<std::uint64_t>& kept, std::uint64_t firstIndex) const {
  Bytes records(kept.size() * bytes_);
  if (records.empty()) return records;
  std::uint8_t* column = records.data();
  for (std::size_t a = 0; a < values.size(); ++a) {
    const std::uint8_t* from = values[a].values.data() + firstTuple * sizes_[a];
    for (std::size_t i = 0; i < kept.size(); ++i) {
      std::memcpy(column + i * bytes_, from + kept[i] * sizes_[a], sizes_[a]);
    }
    column += sizes_[a];
  }
  for (std::size_t i = 0; originalIds_ && i < kept.size(); ++i) {
    const std::uint64_t id = firstIndex + kept[i];
    std::memcpy(column + i * bytes_, &id, sizeof id);
  }
  return records;
}

std::vector<ArrayView> RecordLayout::views(const std::uint8_t* records, std::size_t strideBytes,
                                           std::uint64_t count) const {
  std::vector<ArrayView> views;
  for (std::size_t a = 0; a < arrays_.size(); ++a) {
    ArrayView view;
    static_cast<ArrayDescription&>(view) = arrays_[a];
    view.tuples = count;
    view.data = records;
    view.strideBytes = strideBytes;
    views.push_back(std::move(view));
    if (records != nullptr) records += sizes_[a];
  }
  return views;
}

}  // namespace bspc::streaming
