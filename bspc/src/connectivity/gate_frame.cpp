#include "connectivity/gate_frame.h"

#include <cmath>

#include "entropy/logistic_math.h"

namespace bspc::connectivity {

namespace {

/// Gates at a vertex that are looked at; more meet only where the mesh is no surface.
constexpr unsigned kGatesAtVertex = 16;

}  // namespace

float GateFrame::turn(float along, float inward) {
  const float sum = entropy::magnitude(along) + entropy::magnitude(inward);
  if (sum == 0) return 0;
  const float r = along / sum;
  return inward >= 0 ? 1 - r : 3 + r;
}

GateFrame::GateFrame(const AdvancingFront& meshFront, const Gate& gate)
    : front(&meshFront), origin(meshFront.position(gate.edge.from)) {
  const Position& end = front->position(gate.edge.to);
  double square = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const double d = end[k] - origin[k];
    square += d * d;
  }
  if (square > 0) length = std::sqrt(square);
  logLength = entropy::naturalLog(static_cast<float>(1 + length));
  edge = toVertex(gate.edge.to);
  hasFace = gate.apex != kNoVertex;
  if (hasFace) {
    measureFaceAcross(gate);
    measureNeighbourGates(gate);
  }
}

void GateFrame::measureFaceAcross(const Gate& gate) {
  const Position& end = front->position(gate.edge.to);
  const Position& apex = front->position(gate.apex);
  for (std::size_t k = 0; k < 3; ++k) {
    // A face of four or more corners goes on straight across an edge, a triangle to the middle.
    target[k] = gate.straight ? 2 * (2 * end[k] - apex[k]) : 2 * (origin[k] + end[k] - apex[k]);
    toTarget[k] = static_cast<float>((0.5 * target[k] - origin[k]) / length);
  }
  const Vector toApex = toVertex(gate.apex);
  const Vector fromEnd{toApex[0] - edge[0], toApex[1] - edge[1], toApex[2] - edge[2]};
  const Vector across = cross(toApex, edge);
  const float size = std::sqrt(dot(across, across));
  hasNormal = size > 0;
  if (hasNormal) {
    for (std::size_t k = 0; k < 3; ++k) normal[k] = across[k] / size;
    inward = cross(normal, edge);
  }
  const float first = dot(toApex, toApex);
  const float second = dot(fromEnd, fromEnd);
  logPerimeter = entropy::naturalLog(1 + std::sqrt(first) + std::sqrt(second));
  const float product = first * second;
  apexCosine = product > 0 ? dot(toApex, fromEnd) / std::sqrt(product) : 1;
  longest = first <= 1 && second <= 1;
}

void GateFrame::measureNeighbourGates(const Gate& gate) {
  if (!hasNormal) return;
  front->gates().leaving(gate.edge.to, kGatesAtVertex, [&](std::uint32_t other) {
    if (other == gate.edge.from) return;
    Vector way = toVertex(other);
    for (std::size_t k = 0; k < 3; ++k) way[k] -= edge[k];
    const float angle = turn(-dot(way, edge), dot(way, inward));
    if (angle < leavingTurn) {
      leavingTurn = angle;
      leavingVertex = other;
    }
  });
  front->gates().entering(gate.edge.from, kGatesAtVertex, [&](std::uint32_t other) {
    if (other == gate.edge.to) return;
    const Vector way = toVertex(other);
    const float angle = turn(dot(way, edge), dot(way, inward));
    if (angle < enteringTurn) {
      enteringTurn = angle;
      enteringVertex = other;
    }
  });
}

}  // namespace bspc::connectivity
