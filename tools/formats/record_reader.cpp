#include "formats/record_reader.h"

#include <algorithm>

#include "formats/array_tuples.h"
#include "formats/scalar_convert.h"

namespace bspc::formats {

namespace {

bool isPacked(const RecordLayout& layout) {
  const std::size_t size = scalarSize(layout.positionType);
  bool packed = !layout.swapped && layout.bytes == 3 * size;
  for (std::size_t k = 0; k < 3; ++k) {
    packed =
        packed && layout.xyz[k].offset == k * size && layout.xyz[k].type == layout.positionType;
  }
  return packed;
}

}  // namespace

RecordReader::RecordReader(InputBuffer& in, const RecordLayout& layout)
    : in_(in),
      layout_(layout),
      pointBytes_(3 * scalarSize(layout.positionType)),
      packed_(isPacked(layout)) {}

RecordReader::Result RecordReader::read(std::uint8_t* positions, Span<ArrayValues> values,
                                        std::size_t count) {
  if (packed_) return readPacked(positions, count);
  const std::size_t block = std::max<std::size_t>((std::size_t{1} << 17) / layout_.bytes, 1);
  Result all;
  while (all.records < count && all.status == Status::Ok) {
    const Result part = readBlock(positions + all.records * pointBytes_, values,
                                  std::min(block, count - all.records));
    all = {all.records + part.records, part.status, part.axis};
  }
  return all;
}

RecordReader::Result RecordReader::readPacked(std::uint8_t* positions, std::size_t count) {
  const std::size_t got = in_.read(positions, count * pointBytes_);
  return {got / pointBytes_, got < count * pointBytes_ ? Status::EndOfStream : Status::Ok, 0};
}

RecordReader::Result RecordReader::readBlock(std::uint8_t* positions, Span<ArrayValues> values,
                                             std::size_t count) {
  Result result{count, Status::Ok, 0};
  const bool ends = !in_.ensure(count * layout_.bytes);
  if (ends) result = {in_.available() / layout_.bytes, Status::EndOfStream, 0};
  const std::size_t size = scalarSize(layout_.positionType);
  // Without any record there may be no buffer that offsets could count from.
  for (std::size_t k = 0; k < 3 && result.records > 0; ++k) {
    const RecordLayout::Coordinate& from = layout_.xyz[k];
    const ScalarSource source{in_.data() + from.offset, from.type, layout_.bytes, layout_.swapped};
    const ScalarTarget target{positions + k * size, layout_.positionType, pointBytes_};
    const std::size_t exact = convertScalars(source, target, result.records);
    if (exact < result.records) result = {exact, Status::Inexact, k};
  }
  if (result.records > 0) appendArrays(values, result.records);
  const bool takesRest = result.status == Status::EndOfStream;
  in_.consume(takesRest ? in_.available() : result.records * layout_.bytes);
  return result;
}

void RecordReader::appendArrays(Span<ArrayValues> values, std::size_t count) const {
  for (std::size_t a = 0; a < values.size(); ++a) {
    const std::vector<std::size_t>& offsets = layout_.arrays[a];
    const ScalarType type = values[a].type;
    const std::size_t size = scalarSize(type);
    std::uint8_t* const tuples = appendTuples(values[a], count);
    for (std::size_t k = 0; k < offsets.size(); ++k) {
      const ScalarSource source{in_.data() + offsets[k], type, layout_.bytes, layout_.swapped};
      convertScalars(source, {tuples + k * size, type, offsets.size() * size}, count);
    }
  }
}

}  // namespace bspc::formats
