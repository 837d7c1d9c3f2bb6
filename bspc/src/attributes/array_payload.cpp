#include "attributes/array_payload.h"

#include <string>

#include "bspc/error.h"

namespace bspc::attributes {

namespace {

constexpr unsigned kMethodBits = 4;
constexpr unsigned kMethods = 9;

bool bitOf(unsigned byte, unsigned bit) { return ((byte >> bit) & 1) != 0; }
unsigned flag(bool value, unsigned bit) { return value ? 1U << bit : 0U; }

void expectBelow(container::ByteReader& in, unsigned byte, unsigned bits) {
  if (byte >> bits != 0) in.fail("reserved bits of a method's settings are set");
}

}  // namespace

void writeMethod(ArrayMethod method, container::ByteWriter& out) {
  out.u8(static_cast<unsigned>(method));
}

ArrayMethod readMethod(container::ByteReader& in) {
  const unsigned byte = in.u8();
  const unsigned method = byte & ((1U << kMethodBits) - 1);
  const unsigned version = byte >> kMethodBits;
  if (method >= kMethods || version > 0) {
    throw Error(ErrorCode::Unsupported,
                "an array is coded with method " + std::to_string(method) + ", version " +
                    std::to_string(version) +
                    ", which this version of bspc does not know; a newer one may");
  }
  return static_cast<ArrayMethod>(method);
}

unsigned packed(const BytesSettings& settings) {
  return flag(settings.inputOrder, 0) | flag(settings.delta, 1) | flag(settings.planes, 2);
}

unsigned packed(const QuickSettings& settings) {
  return static_cast<unsigned>(settings.domain) | flag(settings.mean, 2) |
         flag(settings.chained, 3);
}

unsigned packed(const ResidualSettings& settings) {
  return static_cast<unsigned>(settings.predictor) | settings.stiffness << 3 |
         static_cast<unsigned>(settings.domain) << 5;
}

unsigned packed(const CategorySettings& settings, bool escapes) {
  return flag(settings.inputOrder, 0) | flag(settings.delta, 1) | flag(escapes, 2);
}

BytesSettings readBytesSettings(container::ByteReader& in) {
  const unsigned byte = in.u8();
  expectBelow(in, byte, 3);
  return {bitOf(byte, 0), bitOf(byte, 1), bitOf(byte, 2)};
}

bool allows(const NumberShape& shape, QuickSettings::Domain domain) {
  switch (domain) {
    case QuickSettings::Domain::Words:
      return true;
    case QuickSettings::Domain::Numbers:
      return isFloatingPoint(shape.type);
    case QuickSettings::Domain::Unit:
      return isFloatingPoint(shape.type) && shape.components == 3;
  }
  return false;
}

bool allows(const NumberShape& shape, ResidualSettings::Domain domain) {
  switch (domain) {
    case ResidualSettings::Domain::Words:
      return true;
    case ResidualSettings::Domain::Numbers:
      return isFloatingPoint(shape.type);
    case ResidualSettings::Domain::Unit:
      return isFloatingPoint(shape.type) && shape.components == 3;
    case ResidualSettings::Domain::Sphere:
      return shape.sphereHalf > 0;
  }
  return false;
}

QuickSettings quickSettings(const NumberShape& shape) {
  QuickSettings settings;
  settings.kind = numberKind(shape.type);
  settings.components = shape.components;
  return settings;
}

ResidualSettings residualSettings(const NumberShape& shape) {
  ResidualSettings settings;
  settings.kind = numberKind(shape.type);
  settings.components = shape.components;
  settings.sphereHalf = shape.sphereHalf;
  return settings;
}

QuickSettings readQuickSettings(container::ByteReader& in, const NumberShape& shape) {
  const unsigned byte = in.u8();
  expectBelow(in, byte, 4);
  QuickSettings settings = quickSettings(shape);
  settings.domain = static_cast<QuickSettings::Domain>(byte & 3);
  settings.mean = bitOf(byte, 2);
  settings.chained = bitOf(byte, 3);
  if (!allows(shape, settings.domain)) in.fail("numbers cannot be predicted in the way told");
  return settings;
}

ResidualSettings readResidualSettings(container::ByteReader& in, const NumberShape& shape) {
  const unsigned byte = in.u8();
  expectBelow(in, byte, 7);
  ResidualSettings settings = residualSettings(shape);
  const unsigned predictor = byte & 7;
  if (predictor >= kPredictors)
    in.fail("the predictor " + std::to_string(predictor) + " is not known");
  settings.predictor = static_cast<Predictor>(predictor);
  settings.stiffness = (byte >> 3) & 3;
  settings.domain = static_cast<ResidualSettings::Domain>((byte >> 5) & 3);
  if (!allows(shape, settings.domain)) in.fail("numbers cannot be predicted in the way told");
  return settings;
}

CategorySettings readCategorySettings(container::ByteReader& in, bool& escapes) {
  const unsigned byte = in.u8();
  expectBelow(in, byte, 3);
  const CategorySettings settings{bitOf(byte, 0), bitOf(byte, 1)};
  escapes = bitOf(byte, 2);
  if (settings.delta && !settings.inputOrder) {
    in.fail("differences of categories are told outside the order of the input");
  }
  return settings;
}

}  // namespace bspc::attributes
