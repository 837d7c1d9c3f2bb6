#pragma once

#include <array>

#include "connectivity/advancing_front.h"

namespace bspc::connectivity {

using Vector = std::array<float, 3>;

inline float dot(const Vector& a, const Vector& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

inline Vector cross(const Vector& a, const Vector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// The surroundings of a gate, measured in its length: its edge has length 1 (or 0).
struct GateFrame {
  GateFrame(const AdvancingFront& front, const Gate& gate);

  /// From the gate's first vertex to `vertex`, in gate lengths.
  Vector toVertex(std::uint32_t vertex) const {
    const Position& p = front->position(vertex);
    return {static_cast<float>((p[0] - origin[0]) / length),
            static_cast<float>((p[1] - origin[1]) / length),
            static_cast<float>((p[2] - origin[2]) / length)};
  }

  /// Angle of a direction at the gate, seen along the normal of the face across: 0 along the gate
  /// (`along`), 1 where the new face is to lie (`inward`), 2 and 3 beyond; not in degrees, but as
  /// monotone.
  static float turn(float along, float inward);

  const AdvancingFront* front;
  Position origin;
  double length = 1;
  float logLength = 0;      ///< ln(1 + length in grid steps)
  Vector edge{};            ///< from first to second vertex
  bool hasFace = false;     ///< there is a face across
  bool hasNormal = false;   ///< and it is not flat
  Vector normal{};          ///< of the triangle across, as the new face has it: length 1
  Vector inward{};          ///< in that triangle's plane, away from it
  float logPerimeter = 0;   ///< ln of the perimeter of that triangle
  float apexCosine = 0.5F;  ///< cos of its angle at the apex
  bool longest = false;     ///< the gate is its longest side
  Position target{};        ///< where the vertex would complete a parallelogram, doubled
  Vector toTarget{};        ///< the same from the gate's first vertex, in gate lengths

  /// Smallest turn of another gate that leaves the second vertex, or enters the first one, and the
  /// vertex at its other end.
  float leavingTurn = 4;
  float enteringTurn = 4;
  std::uint32_t leavingVertex = kNoVertex;
  std::uint32_t enteringVertex = kNoVertex;

 private:
  void measureFaceAcross(const Gate& gate);
  void measureNeighbourGates(const Gate& gate);
};

}  // namespace bspc::connectivity
