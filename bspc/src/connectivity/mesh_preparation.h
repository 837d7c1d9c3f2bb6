#pragma once

#include <cstdint>
#include <vector>

#include "bspc/mesh.h"

namespace bspc::connectivity {

/// What an encoder finds out about faces before it codes them.
struct PreparedFaces {
  /// The faces, turned around where that makes them consistent with their neighbours.
  Cells faces;
  std::vector<std::uint8_t> flipped;
  bool anyFlipped = false;
  /// Faces that together are an oriented surface: no directed edge twice, no vertex twice in a
  /// face.
  std::vector<std::uint32_t> regular;
  /// The others.
  std::vector<std::uint32_t> irregular;
  std::size_t borderEdges = 0;  ///< edges of regular faces with no regular face on the other side
};

PreparedFaces prepareFaces(const Cells& faces);

/// Makes regular faces irregular but those that were reached. Parts of a surface that hang on
/// others by vertices alone are not reached if each of these has faces by the time that a part
/// could begin at it.
void keepRegular(PreparedFaces& faces, std::vector<std::uint32_t> reached);

}  // namespace bspc::connectivity
