#pragma once

// The decoder of slabs, for one instruction set. To be included by the sources that are compiled
// for one each (slab_reader_portable.cpp, slab_reader_avx2.cpp), and by nothing else.

#include <algorithm>
#include <memory>
#include <string>

#include "container/byte_reader.h"
#include "entropy/lane_set.h"
#include "entropy/symbol_coder.h"
#include "geometry/fast/chunk_coder.h"
#include "geometry/fast/chunk_reader.h"
#include "geometry/fast/slab_body.h"
#include "geometry/fast/slab_curve.h"
#include "geometry/fast/slab_sorter.h"
#include "geometry/fast/slab_tree.h"
#include "geometry/fast/uv_tree.h"

namespace bspc::geometry::fast {
inline namespace BSPC_LANE_SET {

/// The sections of a body, in a copy that can be read past its end.
struct Sections {
  enum { kHead, kTree, kPlane, kResiduals, kFieldStream, kRaw, kCount };

  explicit Sections(ByteView body) {
    container::ByteReader reader(body, "a set of points of method fast",
                                 container::ByteReader::kNoOffset);
    std::size_t sizes[kCount] = {};
    for (unsigned s = 0; s < kRaw; ++s) sizes[s] = reader.varint32();
    const std::size_t start = reader.position();
    std::size_t left = reader.remaining();
    for (unsigned s = 0; s < kRaw; ++s) {
      if (sizes[s] > left) reader.fail("sections that are larger than it");
      left -= sizes[s];
    }
    sizes[kRaw] = left;
    padded.assign(body.begin() + start, body.end());
    padded.resize(padded.size() + kSectionPadding);
    const std::uint8_t* at = padded.data();
    for (unsigned s = 0; s < kCount; ++s) {
      views[s] = ByteView(at, sizes[s]);
      at += sizes[s];
    }
  }

  Bytes padded;
  ByteView views[kCount];
};

class SlabReader {
 public:
  struct Node {};

  SlabReader(const Sections& sections, std::uint64_t points, bool uvTree, unsigned extraLevels,
             PointCollector& out)
      : out_(out),
        chunks_(in_),
        head_(sections.views[Sections::kHead].data(), sections.views[Sections::kHead].size()) {
    const unsigned lanes = ransLanes(points);
    const auto stream = [&sections](unsigned s, unsigned streamLanes) {
      return RansReader(sections.views[s].data(), sections.views[s].size(), streamLanes);
    };
    in_.raw =
        BitReader(sections.views[Sections::kRaw].data(), sections.views[Sections::kRaw].size());
    if (uvTree) {
      uvCoder_ = std::make_unique<entropy::SymbolReader>(sections.views[Sections::kPlane]);
      uvTree_ = std::make_unique<Tree>(*uvCoder_, in_.raw, extraLevels);
    } else {
      in_.gapTables = TableSet(head_, defaultGapTables(), kGapClasses.tables());
      in_.gaps = stream(Sections::kPlane, lanes);
    }
    in_.residualTables = TableSet(head_, defaultResidualTables(), kResidualClasses.tables());
    in_.residuals = stream(Sections::kResiduals, lanes);
    in_.fieldTables = TableSet(head_, defaultFieldTables(), kFields);
    in_.fields = stream(Sections::kFieldStream, 1);
    head_.expectEnd();
  }

  void read(ByteView treeSection, std::uint64_t points) {
    BitReader tree(treeSection.data(), treeSection.size());
    codeSlabTree(tree, *this, Node{}, rootCell(out_.frame().extent), points, out_.frame().scale);
    flush();
    tree.expectEnd();
    in_.expectEnd(!uvTree_);
    if (uvTree_) uvCoder_->finish();
  }

  // The decoder's side of codeSlabTree(): it asks, and takes slabs.
  static bool isSlab(Node /*node*/) { return false; }
  static unsigned heightAxis(Node /*node*/) { return 0; }
  static std::uint64_t countLower(Node /*node*/) { return 0; }
  static Node child(Node /*node*/, unsigned /*half*/) { return {}; }

  void slab(Node /*node*/, const Cell& cell, std::uint64_t points, unsigned heightAxis) {
    const SlabFrame frame(cell, out_.frame().scale, heightAxis, points);
    if (uvTree_) readPlane(frame, points);
    const auto middle = [&frame](unsigned k) { return (std::uint32_t{1} << frame.levels[k]) / 2; };
    SurfaceHistory history(middle(0), middle(1), middle(2));
    lastHeight_ = middle(2);
    std::uint64_t code = 0;
    Chunk& chunk = chunk_;
    for (std::uint64_t first = 0; first < points; first += kChunkPoints) {
      chunk.count = static_cast<std::size_t>(std::min<std::uint64_t>(kChunkPoints, points - first));
      if (!uvTree_) {
        readGaps(frame, code);
        const std::uint64_t left = points - first - chunk.count;
        in_.announceGaps(static_cast<std::size_t>(std::min<std::uint64_t>(kChunkPoints, left)));
      } else if (plane_.empty()) {
        std::fill(chunk.u.begin(), chunk.u.end(), 0U);
        std::fill(chunk.v.begin(), chunk.v.end(), 0U);
      } else {
        for (std::size_t i = 0; i < chunk.count; ++i) {
          const PlanePoint& p = plane_[(*planeOrder_)[first + i]];
          chunk.u[i] = p.c[0];
          chunk.v[i] = p.c[1];
        }
      }
      chunks_.codeHeights(chunk, history);
      restoreHeights(history);
      chunks_.codeCutOff(chunk, frame.cutBits());
      emit(cell, frame);
    }
  }

 private:
  using Tree = UvTree<entropy::SymbolReader, BitReader>;
  using Columns = std::array<std::uint32_t*, 3>;  ///< u, v, w

  void readGaps(const SlabFrame& frame, std::uint64_t& code) {
    chunks_.codeGaps(chunk_);
    for (std::size_t i = 0; i < chunk_.count; ++i) {
      code += chunk_.gaps[i];
      chunk_.gaps[i] = code;
    }
    positionsOfCodes(frame, chunk_.gaps.data(), chunk_.count, chunk_.u.data(), chunk_.v.data());
  }

  void readPlane(const SlabFrame& frame, std::uint64_t points) {
    plane_.clear();
    if (frame.levels[0] + frame.levels[1] == 0) return;
    if (points > Tree::kMaxPoints) {
      throw Error(ErrorCode::Corrupt, "a slab claims " + std::to_string(points) +
                                          " points, more than its tree may have");
    }
    out_.budget().checkBytes(uvTree_->memory(points));
    plane_.resize(static_cast<std::size_t>(points));
    uvTree_->code(frame, out_.frame().scale, plane_);
    codes_.resize(plane_.size());
    for (std::size_t i = 0; i < plane_.size(); ++i) {
      codes_[i] = codeOf(HilbertPlane::instance(), frame, plane_[i].c[0], plane_[i].c[1]);
    }
    planeOrder_ = &sorter_.sort(codes_, frame.codeBits());
  }

  void restoreHeights(SurfaceHistory& history) {
    Chunk& chunk = chunk_;
    const std::size_t count = chunk.count;
    if (chunk.surface.mode == SurfaceMode::Delta) {
      std::uint32_t height = lastHeight_;
      for (std::size_t i = 0; i < count; ++i) {
        height += unzigzag32(chunk.residuals[i]);
        chunk.w[i] = height;
      }
      history.passThrough(chunk.u[count - 1], chunk.v[count - 1], height);
      lastHeight_ = height;
      return;
    }
    if (chunk.surface.mode == SurfaceMode::Constant) {
      evaluate(chunk.surface, nullptr, nullptr, count, chunk.w.data());
      for (std::size_t i = 0; i < count; ++i) chunk.w[i] += unzigzag32(chunk.residuals[i]);
    } else {
      for (std::size_t i = 0; i < count; ++i) {
        chunk.x[i] = chunk.footprint.normal(0, chunk.u[i]);
        chunk.y[i] = chunk.footprint.normal(1, chunk.v[i]);
      }
      evaluate(chunk.surface, chunk.x.data(), chunk.y.data(), count, chunk.w.data());
      // filtered(), with what need not wait for the expectation before taken out of its way.
      std::uint32_t expected = 0;
      std::uint32_t known = 64;
      std::uint32_t last = 0;
      for (std::size_t i = 0; i < count; ++i) {
        expected =
            static_cast<std::uint32_t>(static_cast<std::int32_t>(kFilter1 * expected + known) >> 7);
        const std::uint32_t error = unzigzag32(chunk.residuals[i]);
        known = kFilter1 * error + kFilter2 * last + 64U;
        last = expected + error;
        chunk.w[i] += last;
      }
    }
    history.remember(chunk.footprint, chunk.surface);
    lastHeight_ = chunk.w[count - 1];
  }

  /// Adds the corner of the cell and what was cut off; the local coordinates become ranks.
  void placeInTile(const Cell& cell, const SlabFrame& frame, const Columns& columns) {
    const std::size_t count = chunk_.count;
    unsigned cutBefore = 0;
    for (unsigned k = 0; k < 3; ++k) {
      const unsigned cut = frame.cut[k];
      const std::uint32_t lower = cell.lower[frame.axis[k]];
      std::uint32_t* column = columns[k];
      if (cut == 0) {
        for (std::size_t i = 0; i < count; ++i) column[i] += lower;
        continue;
      }
      const std::uint32_t mask = (1U << cut) - 1;
      for (std::size_t i = 0; i < count; ++i) {
        column[i] = lower + (column[i] << cut) + ((chunk_.cutOff[i] >> cutBefore) & mask);
      }
      cutBefore += cut;
    }
  }

  void emit(const Cell& cell, const SlabFrame& frame) {
    const std::size_t count = chunk_.count;
    const Columns columns{chunk_.u.data(), chunk_.v.data(), chunk_.w.data()};
    placeInTile(cell, frame, columns);
    std::array<const std::uint32_t*, 3> xyz{};
    std::uint32_t outside = 0;
    for (unsigned k = 0; k < 3; ++k) {
      const std::uint32_t extent = out_.frame().extent[frame.axis[k]];
      const std::uint32_t* column = columns[k];
      xyz[frame.axis[k]] = column;
      for (std::size_t i = 0; i < count; ++i) outside |= column[i] > extent ? 1 : 0;
    }
    if (outside != 0) PointCollector::failOutside();
    for (unsigned k = 0; k < 3; ++k) {
      const std::vector<std::uint32_t>& values = out_.frame().values[frame.axis[k]];
      if (values.empty()) continue;
      for (std::size_t i = 0; i < count; ++i) columns[k][i] = values[columns[k][i]];
    }
    if (points_.size() - pointsHeld_ < count) flush();
    GridPoint* to = points_.data() + pointsHeld_;
    for (std::size_t i = 0; i < count; ++i) to[i] = {xyz[0][i], xyz[1][i], xyz[2][i]};
    pointsHeld_ += count;
  }

  void flush() {
    out_.appendInside(points_.data(), pointsHeld_);
    pointsHeld_ = 0;
  }

  PointCollector& out_;
  ChunkReader in_;
  ChunkCoder<ChunkReader> chunks_;
  BitReader head_;
  std::unique_ptr<entropy::SymbolReader> uvCoder_;
  std::unique_ptr<Tree> uvTree_;
  Chunk chunk_{};
  /// Points side by side where the cache has room: an output that grew chunk by chunk would be
  /// filled with zeros before.
  std::array<GridPoint, 8 * kChunkPoints> points_{};
  std::size_t pointsHeld_ = 0;
  std::uint32_t lastHeight_ = 0;
  std::vector<PlanePoint> plane_;
  std::vector<std::uint64_t> codes_;
  CodeSorter sorter_;
  const std::vector<std::uint32_t>* planeOrder_ = nullptr;
};

inline void read(ByteView body, std::uint64_t points, bool uvTree, unsigned extraLevels,
                 std::uint32_t maxDepth, PointCollector& out) {
  const Cell root = rootCell(out.frame().extent);
  const unsigned depth = root.levels[0] + root.levels[1] + root.levels[2];
  if (depth > maxDepth) {
    throw Error(ErrorCode::LimitExceeded, "a tile has cells of depth " + std::to_string(depth) +
                                              ", more than the limit of " +
                                              std::to_string(maxDepth));
  }
  out.budget().checkBytes(body.size());
  const Sections sections(body);
  const auto reader = std::make_unique<SlabReader>(sections, points, uvTree, extraLevels, out);
  reader->read(sections.views[Sections::kTree], points);
}

}  // namespace BSPC_LANE_SET
}  // namespace bspc::geometry::fast
