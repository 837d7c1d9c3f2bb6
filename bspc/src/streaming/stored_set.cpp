#include "streaming/stored_set.h"

#include <numeric>
#include <vector>

#include "grid/grid_fit.h"

namespace bspc::streaming {

StoredSet::StoredSet(const ScratchFactory& scratch, ScalarType type, const RecordLayout& records,
                     bool dropNonFinite)
    : layout_(records), positions_(scratch()), type_(type), dropNonFinite_(dropNonFinite) {
  if (layout_.bytes() > 0) records_ = scratch();
}

void StoredSet::append(ByteView positions, Span<const ArrayValues> values, std::size_t firstTuple) {
  const std::size_t pointBytes = 3 * scalarSize(type_);
  const PointSetView view(positions.data(), type_, positions.size() / pointBytes, 0);
  const std::uint64_t firstIndex = size_ + dropped_;
  lattice::requireIntegersInDoubles(view, firstIndex);
  lattice::FinitePoints finite = lattice::finitePoints(view, dropNonFinite_, firstIndex);
  dropped_ += finite.dropped;
  size_ += view.size() - finite.dropped;
  if (finite.dropped == 0) {
    positions_->append(positions);
  } else {
    Bytes kept;
    for (const std::uint64_t i : finite.kept) {
      const std::uint8_t* at = positions.data() + static_cast<std::size_t>(i) * pointBytes;
      kept.insert(kept.end(), at, at + pointBytes);
    }
    positions_->append(kept);
  }
  if (!records_) return;
  if (finite.dropped == 0) {
    finite.kept.resize(static_cast<std::size_t>(view.size()));
    std::iota(finite.kept.begin(), finite.kept.end(), std::uint64_t{0});
  }
  records_->append(layout_.pack(values, firstTuple, finite.kept, firstIndex));
}

Bytes StoredSet::records(std::uint64_t first, std::size_t count) const {
  Bytes records(count * layout_.bytes());
  if (!records.empty()) records_->read(first * layout_.bytes(), records);
  return records;
}

}  // namespace bspc::streaming
