#include "bspc/arrays.h"

namespace bspc {

std::size_t arrayValueSize(ScalarType type) {
  if (type == ScalarType::Bit) return 1;
  if (type == ScalarType::String) return sizeof(std::string);
  return scalarSize(type);
}

std::uint64_t ArrayValues::tuples() const {
  if (components == 0) return 0;
  const std::size_t count =
      type == ScalarType::String ? strings.size() : values.size() / arrayValueSize(type);
  return count / components;
}

ArrayView ArrayValues::view() const {
  ArrayView view;
  static_cast<ArrayDescription&>(view) = static_cast<const ArrayDescription&>(*this);
  view.tuples = tuples();
  view.data = type == ScalarType::String ? static_cast<const void*>(strings.data())
                                         : static_cast<const void*>(values.data());
  return view;
}

}  // namespace bspc
