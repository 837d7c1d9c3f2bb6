#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "bspc/mesh.h"
#include "connectivity/advancing_front.h"
#include "connectivity/corner_split.h"
#include "connectivity/face_coder.h"
#include "connectivity/numbers.h"
#include "connectivity/plain_cells.h"
#include "connectivity/welding.h"

namespace bspc::connectivity {

/// What stands before the faces.
struct FacesHead {
  std::uint64_t regular = 0;    ///< faces of an oriented surface, coded by the front
  std::uint64_t irregular = 0;  ///< the others
  bool welded = false;          ///< points at the same place are one vertex
  bool triangles = true;        ///< all regular faces are
  bool flips = false;
  bool surestFirst = true;
  unsigned neighbours = 0;  ///< how far rankings look, 1 … 31

  template <class Coder>
  void code(Coder& coder) {
    regular = codeNumber(coder, regular);
    irregular = codeNumber(coder, irregular);
    const auto flag = [&](bool& value) { value = coder.raw(value ? 1 : 0, 1) != 0; };
    flag(welded);
    flag(triangles);
    flag(flips);
    flag(surestFirst);
    neighbours = coder.raw(neighbours, 5);
    if (neighbours == 0) throw Error(ErrorCode::Corrupt, "the faces are coded without neighbours");
  }

  FaceCoding coding() const {
    FaceCoding coding;
    coding.reach = {neighbours, 2 * neighbours, VertexIndex::Among::Awake};
    coding.surestFirst = surestFirst;
    coding.flips = flips;
    return coding;
  }
};

/// Codes the faces over known vertices, for encoder and decoder alike.
template <class Coder, class Truth>
class FacesSection {
 public:
  FacesSection(Coder& coder, const FacesHead& head, Span<const Position> positions)
      : coder_(coder),
        head_(head),
        positions_(positions),
        index_(positions),
        front_(positions, index_, head.triangles) {}

  /// `irregular`: given by an encoder, filled by a decoder.
  template <class Check>
  void codeVertices(Truth& truth, Cells& irregular, Check check) {
    FaceCoder<Coder, Truth> faces(coder_, front_, head_.coding(), truth);
    if (head_.regular > 0 && positions_.empty()) {
      throw Error(ErrorCode::Corrupt, "the file has faces but no points");
    }
    const auto memory = [&] { return front_.bytes() + irregular.indices.capacity() * 4; };
    faces.code(head_.regular, [&] { check(memory()); });
    flipped_ = faces.flipped();
    PlainCells<Coder> plain(coder_, positions_, index_, PlainCells<Coder>::Shape::Face);
    plain.code(head_.irregular, irregular, [&] { check(memory()); });
  }

  const AdvancingFront& front() const { return front_; }

  /// The regular faces as they were before they were turned around; `points`: of all corners.
  void appendRegular(const std::vector<std::uint32_t>& points, Cells& faces) const {
    std::vector<std::uint32_t> face;
    for (std::uint32_t i = 0; i < front_.faces(); ++i) {
      face.assign(points.begin() + front_.faceStart(i), points.begin() + front_.faceStart(i + 1));
      if (!flipped_.empty() && flipped_[i] != 0) std::reverse(face.begin(), face.end());
      faces.add(face);
    }
  }

 private:
  Coder& coder_;
  FacesHead head_;
  Span<const Position> positions_;
  VertexIndex index_;
  AdvancingFront front_;
  std::vector<std::uint8_t> flipped_;
};

}  // namespace bspc::connectivity
