#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "bspc/error.h"
#include "entropy/adaptive_bit.h"
#include "entropy/symbol_coder.h"
#include "geometry/bsp/bsp_cell.h"
#include "geometry/bsp/bsp_count_model.h"
#include "geometry/bsp/cut_parameters.h"
#include "geometry/cell_growth.h"
#include "geometry/kd/kd_count_model.h"

namespace bspc::geometry {

/// The traversal of method bsp, for encoder and decoder alike.
///
/// `Points` answers the encoder's questions and takes the decoder's points:
///   WantedDirection wantedDirection(const BspCell&, frame), double wantedAlpha(…)
///   std::uint64_t partition(const BspCell&, const CutPlane&) points in front, moved to the fore
///   GridPoint at(std::uint64_t j)                            the j-th leaf point
///   void tally(const BspCell&, places, uint64 counts)        points at each place, sorted so
///   void lost()                                              a box has missed a point
///   void emit(const GridPoint&, std::uint64_t count, const BspCell&)
///   void cellsInMemory(std::uint64_t bytes)                  throws if they are too many
///   void working()                                           for each cell of a coarse layer;
///   throws to stop
template <class Coder, class Points>
class BspTreeCoder {
 public:
  BspTreeCoder(const GridPoint& extent, Points& points, std::uint64_t count, std::uint32_t maxDepth,
               const BspParameters& parameters)
      : points_(points), maxDepth_(maxDepth), parameters_(parameters) {
    BspCell root;
    root.box.upper = extent;
    root.count = count;
    whole_.setBox(extent);
    whole_.pack(root.shape);
    frontier_.push_back(std::move(root));
  }

  unsigned level() const { return level_; }
  std::vector<BspCell>& frontier() { return frontier_; }

  /// The parameters; in front of the first layer.
  void head(Coder& coder) {
    parameters_.code(coder);
    slack_ = parameters_.slack();
  }

  /// One coarse layer: all cells that can be are cut, level by level, until there are at least
  /// `enough` (the encoder's wish; the stream says before each level whether the layer goes on).
  void coarseLayer(Coder& coder, std::uint64_t enough) {
    coder_ = &coder;
    while (anyOpen() && coder.bit(deeper_, frontier_.size() < enough)) {
      std::vector<BspCell> next;
      std::uint64_t bytes = bytesOf(frontier_);  // and of the shapes of both levels' cells
      for (const BspCell& cell : frontier_) bytes += cell.bytes();
      for (BspCell& cell : frontier_) {
        const std::size_t before = next.size();
        makeRoom(points_, next, 2, bytes);
        if (open(cell, level_)) {
          cut(cell, level_, next);
          cell.shape = {};
        } else {
          next.push_back(std::move(cell));
        }
        for (std::size_t i = before; i < next.size(); ++i) bytes += next[i].bytes();
        points_.cellsInMemory(bytes + bytesOf(next));
      }
      frontier_.swap(next);
      ++level_;
    }
  }

  /// The last layer: every cell is refined down to its points, one after the other, depth first.
  void finalLayer(Coder& coder) {
    coder_ = &coder;
    std::vector<std::pair<BspCell, unsigned>> open;
    std::vector<BspCell> halves;
    for (BspCell& start : frontier_) {
      open.emplace_back(std::move(start), level_);
      while (!open.empty()) {
        const auto [cell, level] = std::move(open.back());
        open.pop_back();
        if (parameters_.stop.stops(cell.count, level)) {
          points_.emit(cell.box.middle(), cell.count, cell);
        } else if (cell.count == 1 && (small(cell) || !parameters_.stop.level)) {
          place(cell, level);
        } else if (small(cell)) {
          distribute(cell);
        } else {
          halves.clear();
          cut(cell, level, halves);
          for (std::size_t i = halves.size(); i > 0; --i) {
            open.emplace_back(std::move(halves[i - 1]), level + 1);
          }
        }
      }
    }
  }

 private:
  static constexpr unsigned kPlaces = 64;
  /// From this level on cells are boxes, which always get smaller.
  static constexpr unsigned kLastShapeLevel = 160;

  /// Cells of few grid positions are not cut: the positions are told one by one.
  static bool small(const BspCell& cell) { return cell.box.volume() <= kPlaces; }
  bool open(const BspCell& cell, unsigned level) const {
    return !small(cell) && !parameters_.stop.stops(cell.count, level);
  }
  bool anyOpen() const {
    return std::any_of(frontier_.begin(), frontier_.end(),
                       [this](const BspCell& cell) { return open(cell, level_); });
  }

  /// Appends the parts of the cell that hold points, the front one first.
  void cut(const BspCell& cell, unsigned level, std::vector<BspCell>& parts) {
    if (level >= maxDepth_) {
      throw Error(ErrorCode::LimitExceeded,
                  "a tile has cells deeper than the limit of " + std::to_string(maxDepth_));
    }
    if (cell.boxOnly() || level >= kLastShapeLevel) {
      cutBox(cell, parts);
      return;
    }
    whole_.unpack(cell.shape);
    const bool exact = cell.count == 1;
    const CutPlane plane = exact ? middlePlane(cell.box) : codedPlane(cell, level);
    cutShape(cell, plane, exact, parts);
  }

  static CutPlane middlePlane(const GridBox& box) {
    const unsigned axis = box.longestAxis();
    return CutPlane::across(axis, box.lower[axis] + (box.upper[axis] - box.lower[axis]) / 2 + 1);
  }

  /// The paper's cut: parameters in the local frame, with bits by the number of points.
  CutPlane codedPlane(const BspCell& cell, unsigned level) {
    const CutBits bits = parameters_.bits(cell.count, level);
    const bool oriented = bits.phi > 0 || bits.psi > 0;
    const LocalFrame frame = LocalFrame::of(whole_, oriented);
    IntegerVector normal = frame.u;
    if (oriented) {
      WantedDirection wanted;
      if (Coder::kWriting) wanted = points_.wantedDirection(cell, frame);
      const std::int64_t sinPhi =
          planes_.code(*coder_, CutParameterModel::kPhi, bits.phi, wanted.sinPhi / kMaxSinPhi) / 2;
      const std::int64_t reach = sinPhi < 0 ? -sinPhi : sinPhi;
      const double share =
          reach > 0 ? wanted.cosPsi * static_cast<double>(kUnit) / static_cast<double>(reach) : 0;
      const std::int64_t cosPsi =
          planes_.code(*coder_, CutParameterModel::kPsi, bits.psi, std::clamp(share, -1.0, 1.0)) *
          reach / kUnit;
      normal = planeNormal(frame, sinPhi, cosPsi);
    }
    std::int64_t alpha = kUnit / 2;
    if (bits.alpha > 0) {
      double wanted = 0;
      if (Coder::kWriting) wanted = (points_.wantedAlpha(cell, frame, normal) - 0.5) / kAlphaReach;
      const std::int64_t x =
          planes_.code(*coder_, CutParameterModel::kAlpha, bits.alpha, std::clamp(wanted, -1., 1.));
      alpha += roundDivide(3 * x, 10);
    }
    return planeAt(frame, normal, alpha);
  }

  void cutShape(const BspCell& cell, const CutPlane& plane, bool exact,
                std::vector<BspCell>& parts) {
    const PolyhedronCut cut(whole_, plane, exact);
    if (!cut.fits()) {
      cutBox(cell, parts);
      return;
    }
    GridBox frontBox = cell.box;
    GridBox backBox = cell.box;
    if (exact) divide(plane, frontBox, backBox);
    const bool divided = cut.hasFront() && cut.hasBack();
    if (divided) {
      cut.build(true, front_);
      cut.build(false, back_);
      frontBox = front_.gridBox(frontBox, slack_);
      backBox = back_.gridBox(backBox, slack_);
    } else {
      (cut.hasFront() ? backBox : frontBox).empty = true;
    }
    const Shapes shapes{divided ? &front_ : nullptr, divided ? &back_ : nullptr};
    share(cell, plane, frontBox, backBox, shapes, parts);
  }

  /// Null where the side has the cell's own shape, or none.
  struct Shapes {
    const Polyhedron* front;
    const Polyhedron* back;
  };

  /// What a plane across an axis leaves of a box, which both sides are at first.
  static void divide(const CutPlane& plane, GridBox& front, GridBox& back) {
    for (unsigned k = 0; k < 3; ++k) {
      if (plane.normal[k] == 0) continue;
      const auto at = static_cast<std::uint32_t>(plane.offset / 2);
      front.lower[k] = at;
      back.upper[k] = at - 1;
    }
  }

  void cutBox(const BspCell& cell, std::vector<BspCell>& parts) {
    BspCell box = cell;
    box.shape.clear();
    const CutPlane plane = middlePlane(cell.box);
    GridBox front = cell.box;
    GridBox back = cell.box;
    divide(plane, front, back);
    share(box, plane, front, back, {nullptr, nullptr}, parts);
  }

  /// Codes which points lie in front, if both sides can hold any, and appends the parts.
  void share(const BspCell& cell, const CutPlane& plane, const GridBox& frontBox,
             const GridBox& backBox, const Shapes& shapes, std::vector<BspCell>& parts) {
    std::uint64_t inFront = Coder::kWriting ? points_.partition(cell, plane) : 0;
    unsigned history = cell.history;
    if (frontBox.empty || backBox.empty) {
      const std::uint64_t forced = frontBox.empty ? 0 : cell.count;
      if (Coder::kWriting && inFront != forced) points_.lost();
      inFront = forced;
    } else if (cell.count == 1) {
      inFront = coder_->fixedBit(frontShare(shapes, frontBox, backBox), inFront != 0) ? 1 : 0;
    } else {
      inFront = counts_.code(*coder_, inFront, cell.count, history);
      constexpr unsigned kMask = (1U << BspCountModel::kHistoryBits) - 1;
      history = ((history << 1) | (inFront == 0 || inFront == cell.count ? 1U : 0U)) & kMask;
    }
    append(cell, shapes.front, frontBox, 0, inFront, history, parts);
    append(cell, shapes.back, backBox, inFront, cell.count - inFront, history, parts);
  }

  /// How likely a lone point lies in front, in units of 2^-16: as the volumes are.
  std::uint32_t frontShare(const Shapes& shapes, const GridBox& frontBox,
                           const GridBox& backBox) const {
    std::uint64_t front = 0;
    std::uint64_t back = 0;
    if (shapes.front != nullptr) {
      const unsigned shift = whole_.volumeShift();
      front = static_cast<std::uint64_t>(shapes.front->volume(shift));
      back = static_cast<std::uint64_t>(shapes.back->volume(shift));
    } else {
      front = frontBox.volume();
      back = backBox.volume();
    }
    while (((front | back) >> 40) != 0) {
      front >>= 1;
      back >>= 1;
    }
    const std::uint64_t share = ((front + 1) << 16) / (front + back + 2);
    return static_cast<std::uint32_t>(std::clamp<std::uint64_t>(share, kLeastShare, kMostShare));
  }
  static constexpr std::uint64_t kLeastShare = 1536;
  static constexpr std::uint64_t kMostShare = 64000;

  static void append(const BspCell& cell, const Polyhedron* shape, const GridBox& box,
                     std::uint64_t offset, std::uint64_t count, unsigned history,
                     std::vector<BspCell>& parts) {
    if (count == 0) return;
    parts.emplace_back();
    BspCell& part = parts.back();
    if (shape != nullptr) {
      // Bisection leaves a lone point in a plain box sooner or later.
      if (count > 1 || !shape->isBox()) shape->pack(part.shape);
    } else {
      part.shape = cell.shape;
    }
    part.box = box;
    part.history = history;
    part.count = count;
    part.first = cell.first + offset;
    part.id = cell.id;
  }

  /// A lone point of a cell that is not small: bisected in place, without packing shapes.
  void place(const BspCell& start, unsigned level) {
    std::vector<BspCell>& parts = lone_;
    BspCell cell = start;
    while (!small(cell) && !cell.boxOnly()) {
      parts.clear();
      cut(cell, level++, parts);
      std::swap(cell, parts.front());
    }
    if (!cell.boxOnly()) {
      distribute(cell);
      return;
    }
    GridPoint point = Coder::kWriting ? points_.at(cell.first) : GridPoint{};
    if (Coder::kWriting && !cell.box.contains(point)) points_.lost();
    for (unsigned k = 0; k < 3; ++k) {
      point[k] = cell.box.lower[k] + coder_->uniform(point[k] - cell.box.lower[k],
                                                     cell.box.upper[k] - cell.box.lower[k]);
    }
    points_.emit(point, 1, cell);
  }

  /// The points of a small cell among the grid positions that it may hold.
  void distribute(const BspCell& cell) {
    std::array<GridPoint, kPlaces> places;
    const unsigned count = listPlaces(cell, places);
    if (count == 0) {
      throw Error(ErrorCode::Corrupt, "a cell that should hold points has no grid position");
    }
    std::array<std::uint64_t, kPlaces> points{};
    if (Coder::kWriting) points_.tally(cell, places.data(), count, points.data());
    distribute(cell, places.data(), points.data(), count, cell.count);
  }

  unsigned listPlaces(const BspCell& cell, std::array<GridPoint, kPlaces>& places) {
    if (!cell.boxOnly()) whole_.unpack(cell.shape);
    unsigned count = 0;
    const GridBox& box = cell.box;
    GridPoint p{};
    for (p[2] = box.lower[2]; p[2] <= box.upper[2]; ++p[2]) {
      for (p[1] = box.lower[1]; p[1] <= box.upper[1]; ++p[1]) {
        for (p[0] = box.lower[0]; p[0] <= box.upper[0]; ++p[0]) {
          if (cell.boxOnly() || whole_.contains(p)) places[count++] = p;
        }
      }
    }
    return count;
  }

  /// Halves the list of places until each part is one place or has one point.
  void distribute(const BspCell& cell, const GridPoint* places, const std::uint64_t* points,
                  unsigned count, std::uint64_t sum) {
    if (sum == 0) return;
    if (count == 1) {
      points_.emit(places[0], sum, cell);
      return;
    }
    if (sum == 1) {
      const auto found =
          static_cast<std::uint32_t>(std::find(points, points + count, std::uint64_t{1}) - points);
      const std::uint32_t index = coder_->slice(Coder::kWriting ? found : 0, count);
      points_.emit(places[index], 1, cell);
      return;
    }
    const unsigned half = count / 2;
    std::uint64_t lower = 0;
    for (unsigned i = 0; i < half; ++i) lower += points[i];
    const auto fill = static_cast<unsigned>(std::min<std::uint64_t>(4 * sum / (count + 1), 3));
    lower = places_.code(*coder_, lower, sum, {entropy::bitLength(count), fill + 1});
    distribute(cell, places, points, half, lower);
    distribute(cell, places + half, points + half, count - half, sum - lower);
  }

  Points& points_;
  std::uint32_t maxDepth_;
  BspParameters parameters_;
  std::int64_t slack_ = 0;
  Coder* coder_ = nullptr;
  unsigned level_ = 0;
  std::vector<BspCell> frontier_;
  std::vector<BspCell> lone_;
  Polyhedron whole_;
  Polyhedron front_;
  Polyhedron back_;
  CutParameterModel planes_;
  BspCountModel counts_;
  KdCountModel places_;
  entropy::AdaptiveBit deeper_;
};

}  // namespace bspc::geometry
