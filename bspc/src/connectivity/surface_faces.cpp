#include "connectivity/surface_faces.h"

#include <numeric>
#include <utility>

#include "connectivity/face_truth.h"
#include "connectivity/surface_coder.h"

namespace bspc::connectivity {

namespace {

/// Of what is known of a vertex, and of a corner: in lists of gates, the queue, the result.
constexpr std::uint64_t kBytesPerVertex = 32;
constexpr std::uint64_t kBytesPerCorner = 64;
/// Of the models.
constexpr std::uint64_t kFixedBytes = std::uint64_t{4} << 20;

struct SurfaceHead {
  std::uint64_t faces = 0;
  bool triangles = true;

  template <class Coder>
  void code(Coder& coder) {
    faces = codeNumber(coder, faces);
    if (faces > 0) triangles = coder.raw(triangles ? 1 : 0, 1) != 0;
  }
};

template <class Coder, class Truth, class Check>
SurfaceFaces codeSurface(Coder& coder, const SurfaceHead& head, Truth& truth, std::uint32_t points,
                         Check check) {
  FaceFront front(0, head.triangles);
  SurfaceCoder<Coder, Truth> surface(coder, front, truth, points);
  surface.code(head.faces, [&](std::uint64_t corners) {
    check(3 * front.bytes() + kBytesPerVertex * front.vertices() + kBytesPerCorner * corners);
  });
  SurfaceFaces result;
  result.vertices = static_cast<std::uint32_t>(front.vertices());
  result.given = surface.takeGiven();
  for (std::uint32_t i = 0; i < front.faces(); ++i) {
    const std::uint32_t start = front.faceStart(i);
    result.faces.add(front.allCorners().subspan(start, front.faceStart(i + 1) - start));
  }
  return result;
}

}  // namespace

SurfaceFaces encodeSurface(entropy::SymbolWriter& coder, const Cells& faces, std::uint32_t points) {
  SurfaceHead head;
  head.faces = faces.size();
  for (std::size_t i = 0; i < faces.size(); ++i) {
    head.triangles = head.triangles && faces[i].size() == 3;
  }
  head.code(coder);
  if (faces.empty()) return {};
  std::vector<std::uint32_t> chosen(faces.size());
  std::iota(chosen.begin(), chosen.end(), 0U);
  const std::vector<std::uint8_t> flipped(faces.size(), 0);
  FaceTruth truth(faces, flipped, chosen, points);
  return codeSurface(coder, head, truth, points, [](std::uint64_t) {});
}

SurfaceFaces decodeSurface(entropy::SymbolReader& coder, std::uint32_t points,
                           const MemoryCheck& check) {
  SurfaceHead head;
  head.code(coder);
  if (head.faces == 0) return {};
  check(kFixedBytes);
  UnknownFaces truth;
  return codeSurface(coder, head, truth, points,
                     [&](std::uint64_t bytes) { check(kFixedBytes + bytes); });
}

}  // namespace bspc::connectivity
