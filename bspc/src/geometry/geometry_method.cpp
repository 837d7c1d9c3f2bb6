#include "geometry/geometry_method.h"

#include <array>

#include "geometry/bsp/bsp_method.h"
#include "geometry/fast/fast_method.h"
#include "geometry/kd/kd_method.h"
#include "geometry/partition/partition_method.h"
#include "geometry/predictive/predictive_method.h"
#include "geometry/surface/surface_method.h"

namespace bspc {

namespace {

struct NamedMethod {
  Method id;
  const char* name;
};

constexpr std::array<NamedMethod, 7> kMethods{{
    {Method::Kd, "kd"},
    {Method::Fast, "fast"},
    {Method::Bsp, "bsp"},
    {Method::Octree, "octree"},
    {Method::GenCode, "gencode"},
    {Method::Predictive, "predictive"},
    {Method::Surface, "surface"},
}};

}  // namespace

const char* methodName(Method method) {
  for (const NamedMethod& m : kMethods) {
    if (m.id == method) return m.name;
  }
  return "unknown";
}

std::optional<Method> methodFromName(const std::string& name) {
  for (const NamedMethod& m : kMethods) {
    if (name == m.name) return m.id;
  }
  return std::nullopt;
}

std::vector<Method> availableMethods() {
  std::vector<Method> methods;
  methods.reserve(kMethods.size());
  for (const NamedMethod& m : kMethods) methods.push_back(m.id);
  return methods;
}

namespace geometry {

const GeometryMethod* findGeometryMethod(Method id) {
  static const KdMethod kd;
  static const FastMethod fast;
  static const BspMethod bsp;
  static const PredictiveMethod predictive;
  static const SurfaceMethod surface;
  switch (id) {
    case Method::Kd:
      return &kd;
    case Method::Fast:
      return &fast;
    case Method::Bsp:
      return &bsp;
    case Method::Octree:
      return &octreeMethod();
    case Method::GenCode:
      return &genCodeMethod();
    case Method::Predictive:
      return &predictive;
    case Method::Surface:
      return &surface;
  }
  return nullptr;
}

}  // namespace geometry
}  // namespace bspc
