#include "connectivity/advancing_front.h"

namespace bspc::connectivity {

Gate AdvancingFront::gateAt(Edge edge) const {
  Gate gate;
  gate.edge = edge;
  const std::uint32_t across = faceAt(edge.to, edge.from);
  if (across == kNoVertex) return gate;
  gate.apex = apexOf(edge.to, edge.from);
  gate.straight = corners(across) > 3;
  return gate;
}

void AdvancingFront::add(Span<const std::uint32_t> face, std::vector<Edge>& opened) {
  place(face, opened);
  for (const std::uint32_t vertex : face) settle(vertex);
}

void AdvancingFront::markBorder(Edge edge) {
  close(edge);
  settle(edge.from);
  settle(edge.to);
}

void AdvancingFront::settle(std::uint32_t vertex) {
  if (gates().count(vertex) > 0) {
    index_.wake(vertex);
  } else if (valence(vertex) > 0) {
    index_.putToSleep(vertex);
  }
}

}  // namespace bspc::connectivity
