#include "attributes/exception_list.h"

#include "attributes/byte_planes.h"

namespace bspc::attributes {

void ExceptionList::write(container::ByteWriter& out) const {
  constexpr int kLevel = 9;
  out.varint(places.size());
  if (places.empty()) return;
  container::ByteWriter gaps;
  std::uint64_t next = 0;
  for (const std::uint64_t place : places) {
    gaps.varint(place - next);
    next = place + 1;
  }
  out.varint(gaps.size());
  PlaneWriter rows(kLevel);
  rows.write(gaps.data(), out);
  rows.write(contents, out);
}

ExceptionList ExceptionList::read(container::ByteReader& in, std::uint64_t end, std::size_t size,
                                  MemoryBudget& budget) {
  ExceptionList result;
  const std::uint64_t count = in.varint();
  if (count > end) in.fail("there are more exceptions than numbers");
  if (count == 0) return result;
  constexpr std::uint64_t kLongestGap = 10;  // bytes
  const std::uint64_t gapBytes = in.varint();
  if (gapBytes / kLongestGap > count) in.fail("the places of exceptions take too many bytes");
  PlaneReader rows;
  const Bytes packed = rows.readClaimed(in, gapBytes, budget);
  container::ByteReader gaps(packed, "the places of exceptions", container::ByteReader::kNoOffset);
  budget.take(count, sizeof(std::uint64_t) + size);
  std::uint64_t next = 0;
  for (std::uint64_t i = 0; i < count; ++i) {
    const std::uint64_t gap = gaps.varint();
    if (gap >= end - next) in.fail("an exception lies behind the last number");
    result.places.push_back(next + gap);
    next += gap + 1;
  }
  gaps.expectEnd();
  result.contents.resize(static_cast<std::size_t>(count) * size);
  rows.read(in, result.contents);
  return result;
}

}  // namespace bspc::attributes
