#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "bspc/encoder.h"
#include "formats/model.h"

namespace bspc::paper {

/// Bits of the paper's grid.
constexpr unsigned kBits = 12;

/// A model file on a grid whose longest side spans 2^kBits − 1 steps, as the paper has it; points
/// that are on an integer grid of at most so many bits already are left on it.
struct GriddedModel {
  std::string name;
  std::vector<GridPoint> points;
  std::vector<std::int32_t> xyz;  ///< the same, for the encoder

  PointSetView view() const { return PointSetView(xyz.data(), points.size()); }
};

/// Throws std::exception with a message that names the file.
GriddedModel readGridded(const std::string& path);

/// One coding of a model and what came back of it.
struct Coding {
  std::uint64_t fileBytes = 0;
  double bitsPerPoint = 0;          ///< of the whole file
  std::vector<GridPoint> restored;  ///< restored[i]: what point i of the model came back as
  std::vector<std::uint64_t> cell;  ///< cell[i]: the leaf cell that point i lies in
  std::uint64_t cells = 0;
  double encodeSeconds = 0;  ///< processor time
  double decodeSeconds = 0;
  double rms = 0;       ///< of the distances to the restored points, in grid steps
  double greatest = 0;  ///< of the same
  bool exact() const { return greatest == 0; }
};

/// Encodes in one layer and decodes again.
Coding codeAndDecode(const GriddedModel& model, const EncodeOptions& options);

/// The options for a method with a lossy stop.
EncodeOptions stopAtLevel(Method method, unsigned level);
EncodeOptions stopAtPoints(Method method, std::uint64_t points);

/// Levels from 0 on until nothing is cut any more.
std::vector<Coding> codeEveryLevel(const GriddedModel& model, Method method);

}  // namespace bspc::paper
