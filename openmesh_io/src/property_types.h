#pragma once

#include <OpenMesh/Core/Geometry/VectorT.hh>
#include <OpenMesh/Core/Utils/Property.hh>
#include <cstdint>
#include <string>
#include <type_traits>

#include "bspc/scalar_type.h"

namespace bspc::openmesh {

/// The numbers that a value of a property consists of.
template <class T>
struct ValueTraits {
  using Number = T;
  static constexpr std::uint32_t kComponents = 1;
};
template <class S, int N>
struct ValueTraits<OpenMesh::VectorT<S, N>> {
  using Number = S;
  static constexpr std::uint32_t kComponents = N;
};

template <class T>
constexpr ScalarType scalarTypeOf() {
  using S = typename ValueTraits<T>::Number;
  if constexpr (std::is_same_v<S, std::string>) {
    return ScalarType::String;
  } else if constexpr (std::is_same_v<S, bool>) {
    return ScalarType::Bit;
  } else if constexpr (std::is_floating_point_v<S>) {
    return sizeof(S) == 4 ? ScalarType::Float32 : ScalarType::Float64;
  } else {
    constexpr bool kSigned = std::is_signed_v<S>;
    switch (sizeof(S)) {
      case 1:
        return kSigned ? ScalarType::Int8 : ScalarType::UInt8;
      case 2:
        return kSigned ? ScalarType::Int16 : ScalarType::UInt16;
      case 4:
        return kSigned ? ScalarType::Int32 : ScalarType::UInt32;
      default:
        return kSigned ? ScalarType::Int64 : ScalarType::UInt64;
    }
  }
}

template <class T>
struct TypeTag {
  using Type = T;
};

/// Calls visit(TypeTag<T>) for types of properties that can be stored, until one returns true.
template <class Visit>
bool anyPropertyType(Visit visit) {
  const auto vectors = [&](auto number) {
    using S = typename decltype(number)::Type;
    return visit(TypeTag<OpenMesh::VectorT<S, 2>>()) || visit(TypeTag<OpenMesh::VectorT<S, 3>>()) ||
           visit(TypeTag<OpenMesh::VectorT<S, 4>>());
  };
  const auto numbers = [&](auto number) { return visit(number) || vectors(number); };
  return numbers(TypeTag<float>()) || numbers(TypeTag<double>()) ||
         numbers(TypeTag<std::int32_t>()) || numbers(TypeTag<std::uint32_t>()) ||
         numbers(TypeTag<std::uint8_t>()) || numbers(TypeTag<std::int8_t>()) ||
         numbers(TypeTag<std::int16_t>()) || numbers(TypeTag<std::uint16_t>()) ||
         visit(TypeTag<std::int64_t>()) || visit(TypeTag<std::uint64_t>()) ||
         visit(TypeTag<bool>()) || visit(TypeTag<std::string>());
}

}  // namespace bspc::openmesh
