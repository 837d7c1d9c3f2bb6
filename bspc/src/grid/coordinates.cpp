#include "grid/coordinates.h"

#include <cstring>
#include <string>
#include <type_traits>

#include "bspc/error.h"

namespace bspc::lattice {

namespace {

template <class T>
T load(const unsigned char* from) {
  T value{};
  std::memcpy(&value, from, sizeof value);  // strides need not keep numbers aligned
  return value;
}

template <class T>
void requireWithin(const PointSetView& points, std::uint64_t firstIndex) {
  constexpr auto kLimit = static_cast<T>(std::int64_t{1} << 53);
  const auto* data = static_cast<const unsigned char*>(points.data());
  for (std::uint64_t i = 0; i < points.size(); ++i) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const T value = load<T>(data + i * points.strideBytes() + axis * sizeof(T));
      bool within = value <= kLimit;
      if constexpr (std::is_signed_v<T>) within = within && value >= -kLimit;
      if (within) continue;
      throw Error(ErrorCode::InvalidArgument,
                  "point " + std::to_string(firstIndex + i) + " has " + "xyz"[axis] + " = " +
                      std::to_string(value) +
                      ", beyond the integers up to 2^53 that a grid can restore; subtract an "
                      "offset from the coordinates");
    }
  }
}

}  // namespace

template <class T>
void ViewCoordinates::gatherAs(std::size_t axis, std::uint64_t first, std::size_t count,
                               double* out, std::uint64_t hop) const {
  const std::size_t stride = points_.strideBytes();
  const auto* data = static_cast<const unsigned char*>(points_.data()) + axis * sizeof(T);
  if (kept_.empty()) {
    const unsigned char* from = data + first * stride;
    for (std::size_t i = 0; i < count; ++i) {
      out[i] = static_cast<double>(load<T>(from + i * hop * stride));
    }
    return;
  }
  for (std::size_t i = 0; i < count; ++i) {
    out[i] = static_cast<double>(load<T>(data + kept_[first + i * hop] * stride));
  }
}

void ViewCoordinates::gather(std::size_t axis, std::uint64_t first, std::size_t count, double* out,
                             std::uint64_t hop) const {
  switch (points_.type()) {
    case ScalarType::Float32:
      return gatherAs<float>(axis, first, count, out, hop);
    case ScalarType::Float64:
      return gatherAs<double>(axis, first, count, out, hop);
    case ScalarType::Int8:
      return gatherAs<std::int8_t>(axis, first, count, out, hop);
    case ScalarType::UInt8:
      return gatherAs<std::uint8_t>(axis, first, count, out, hop);
    case ScalarType::Int16:
      return gatherAs<std::int16_t>(axis, first, count, out, hop);
    case ScalarType::UInt16:
      return gatherAs<std::uint16_t>(axis, first, count, out, hop);
    case ScalarType::Int32:
      return gatherAs<std::int32_t>(axis, first, count, out, hop);
    case ScalarType::UInt32:
      return gatherAs<std::uint32_t>(axis, first, count, out, hop);
    case ScalarType::Int64:
      return gatherAs<std::int64_t>(axis, first, count, out, hop);
    case ScalarType::UInt64:
      return gatherAs<std::uint64_t>(axis, first, count, out, hop);
    case ScalarType::Bit:
    case ScalarType::String:
      break;  // PointSetView refuses them
  }
}

std::vector<double> Coordinates::sample(std::size_t axis, std::size_t wanted) const {
  if (size_ == 0 || wanted == 0) return {};
  const std::uint64_t hop = (size_ + wanted - 1) / wanted;
  std::vector<double> values(static_cast<std::size_t>((size_ + hop - 1) / hop));
  gather(axis, 0, values.size(), values.data(), hop);
  return values;
}

void requireIntegersInDoubles(const PointSetView& points, std::uint64_t firstIndex) {
  if (points.type() == ScalarType::Int64) requireWithin<std::int64_t>(points, firstIndex);
  if (points.type() == ScalarType::UInt64) requireWithin<std::uint64_t>(points, firstIndex);
}

}  // namespace bspc::lattice
