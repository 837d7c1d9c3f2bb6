#include "geometry/predictive/camera_fit.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <numeric>
#include <vector>

#include "geometry/predictive/depth_classes.h"
#include "geometry/predictive/periodogram.h"

namespace bspc::geometry::predictive {

namespace {

constexpr double kTurn = 6.283185307179586;

/// The width of a pixel measured at one depth.
struct PixelWidth {
  double depth = 0;
  double width = 0;
  double weight = 0;
};

/// width = pitch · (depth + depthOffset)
struct WidthLine {
  double pitch = 0;
  double depthOffset = 0;
};

/// A camera in real numbers, as PinholeCamera.
struct RealCamera {
  std::array<double, 2> pitch{};
  double depthOffset = 0;
  std::array<double, 2> offset{};
  std::array<double, 2> centre{};
};

std::optional<PinholeCamera> wholeNumbers(const RealCamera& real, unsigned axis) {
  const double limit = std::ldexp(1.0, static_cast<int>(PinholeCamera::kParameterBits) - 2);
  const auto rounded = [&](double value, double unit, std::int64_t& result) {
    const double scaled = value * unit;
    if (!(std::fabs(scaled) < limit)) return false;
    result = std::llround(scaled);
    return true;
  };
  PinholeCamera camera;
  camera.depthAxis = axis;
  bool good = rounded(real.depthOffset, PinholeCamera::kUnit, camera.depthOffset);
  for (unsigned k = 0; k < 2; ++k) {
    // Whole pixels of the centre belong to the numbering of the pixels.
    const double centre = real.centre[k] - std::round(real.centre[k]);
    good = good && rounded(real.pitch[k], PinholeCamera::kPitchUnit, camera.pitch[k]) &&
           rounded(real.offset[k], PinholeCamera::kUnit, camera.offset[k]) &&
           rounded(centre, PinholeCamera::kUnit, camera.centre[k]);
  }
  if (!good) return std::nullopt;
  return camera;
}

/// Measures the width of pixels from the columns (k = 0) or rows that points of a depth stand in.
class WidthMeter {
 public:
  std::optional<PixelWidth> measure(const DepthClasses& classes, std::size_t i, unsigned k) {
    constexpr std::size_t kWindow = 120;
    constexpr std::size_t kLeastValues = 40;
    constexpr double kLowest = 0.004;
    constexpr double kLeastCoherence = 0.55;
    values_.clear();
    for (const DepthClasses::Place& place : classes.places(i)) values_.push_back(place[k]);
    std::sort(values_.begin(), values_.end());
    values_.erase(std::unique(values_.begin(), values_.end()), values_.end());
    if (values_.size() < kLeastValues) return std::nullopt;
    const std::size_t size = std::min(values_.size(), kWindow);
    const Span<const std::uint32_t> window =
        Span<const std::uint32_t>(values_).subspan(densestWindow(values_, size), size);
    const std::optional<LatticePeak> peak = periodogram_.peak(window, kLowest);
    if (!peak || peak->coherence < kLeastCoherence) return std::nullopt;
    const double reach = static_cast<double>(window[size - 1] - window[0]) + 1;
    const double frequency = sharpenedFrequency(window, peak->frequency, reach);
    return PixelWidth{static_cast<double>(classes.depth(i)), 1 / frequency,
                      peak->coherence * peak->coherence * reach};
  }

 private:
  Periodogram periodogram_;
  std::vector<std::uint32_t> values_;
};

/// The line that most widths lie near, by trying each pair of them; refined by least squares.
std::optional<WidthLine> consensusLine(const std::vector<PixelWidth>& widths) {
  constexpr std::size_t kLeastWidths = 6;
  constexpr double kTolerance = 0.01;
  constexpr double kLeastSupport = 0.25;
  if (widths.size() < kLeastWidths) return std::nullopt;
  const auto [lowest, highest] = std::minmax_element(
      widths.begin(), widths.end(),
      [](const PixelWidth& l, const PixelWidth& r) { return l.depth < r.depth; });
  const double leastApart = (highest->depth - lowest->depth) / 16;
  double best = 0;
  double slope = 0;
  double level = 0;
  const auto error = [&](const PixelWidth& w, double s, double l) {
    return std::fabs(w.width - s * w.depth - l) / w.width;
  };
  for (const PixelWidth& a : widths) {
    for (const PixelWidth& b : widths) {
      if (!(b.depth - a.depth > leastApart)) continue;
      const double s = (b.width - a.width) / (b.depth - a.depth);
      const double l = a.width - s * a.depth;
      double support = 0;
      for (const PixelWidth& w : widths) support += std::max(0.0, 1 - error(w, s, l) / kTolerance);
      if (support <= best) continue;
      best = support;
      slope = s;
      level = l;
    }
  }
  if (best < kLeastSupport * static_cast<double>(widths.size())) return std::nullopt;
  double n = 0, z = 0, w = 0, zz = 0, zw = 0;
  for (const PixelWidth& m : widths) {
    if (error(m, slope, level) > kTolerance) continue;
    const double weight = m.weight * m.weight / (m.width * m.width * m.width * m.width);
    n += weight;
    z += weight * m.depth;
    w += weight * m.width;
    zz += weight * m.depth * m.depth;
    zw += weight * m.depth * m.width;
  }
  const double determinant = n * zz - z * z;
  if (determinant > 1e-9 * n * zz) {
    slope = (n * zw - z * w) / determinant;
    level = (w - slope * z) / n;
  }
  // Pixels that do not grow with depth are no camera's.
  if (std::fabs(slope) * (highest->depth - lowest->depth) < 0.02 * highest->width) {
    return std::nullopt;
  }
  return WidthLine{slope, level / slope};
}

std::array<std::optional<WidthLine>, 2> widthLines(const DepthClasses& classes) {
  constexpr std::size_t kClasses = 60;
  constexpr std::size_t kFirstLook = 12;
  std::vector<std::size_t> order(classes.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t l, std::size_t r) {
    return classes.places(l).size() > classes.places(r).size();
  });
  order.resize(std::min(order.size(), kClasses));
  WidthMeter meter;
  std::array<std::optional<WidthLine>, 2> lines;
  for (unsigned k = 0; k < 2; ++k) {
    std::vector<PixelWidth> widths;
    for (std::size_t i = 0; i < order.size(); ++i) {
      if (const auto width = meter.measure(classes, order[i], k)) widths.push_back(*width);
      if (i == kFirstLook && widths.size() < kFirstLook / 4) break;
    }
    lines[k] = consensusLine(widths);
  }
  return lines;
}

/// Finds where the picture's axis stands along one grid axis: there all points lie at whole pixels
/// plus the same fraction of one.
class AxisSearch {
 public:
  AxisSearch(const DepthClasses& classes, unsigned k, const WidthLine& line, double extent)
      : classes_(classes), k_(k), line_(line), extent_(extent) {}

  struct Result {
    WidthLine line;
    double offset = 0;
    double centre = 0;
    double coherence = 0;
  };

  Result run() {
    const double start = scan();
    return climb(start);
  }

 private:
  /// The offset of greatest coherence, at the line as it was measured. The points of a class turn
  /// together as the offset moves.
  double scan() const {
    std::vector<std::complex<double>> phase;
    std::vector<double> turns;  // per grid step
    for (std::size_t i = 0; i < classes_.size(); ++i) {
      const double width = line_.pitch * (classes_.depth(i) + line_.depthOffset);
      if (!(width > 1)) continue;
      std::complex<double> sum = 0;
      for (const DepthClasses::Place& place : classes_.places(i)) {
        sum += std::polar(1.0, kTurn * std::fmod(place[k_] / width, 1.0));
      }
      phase.push_back(sum);
      turns.push_back(1 / width);
    }
    if (phase.empty()) return 0;
    constexpr double kMaxSteps = 32768;
    const double from = -2 * extent_;
    const double step = std::max(0.5, 3 * extent_ / kMaxSteps);
    std::vector<std::complex<double>> turn;
    turn.reserve(turns.size());
    for (std::size_t i = 0; i < turns.size(); ++i) {
      phase[i] *= std::polar(1.0, kTurn * std::fmod(from * turns[i], 1.0));
      turn.push_back(std::polar(1.0, kTurn * step * turns[i]));
    }
    double best = 0;
    double at = 0;
    const auto steps = static_cast<int>(3 * extent_ / step) + 1;
    for (int taken = 0; taken < steps; ++taken) {
      double x = 0;
      double y = 0;
      for (std::size_t i = 0; i < phase.size(); ++i) {
        const double re = phase[i].real();
        const double im = phase[i].imag();
        x += re;
        y += im;
        phase[i] = {re * turn[i].real() - im * turn[i].imag(),
                    re * turn[i].imag() + im * turn[i].real()};
      }
      if (x * x + y * y <= best) continue;
      best = x * x + y * y;
      at = from + taken * step;
    }
    return at;
  }

  std::complex<double> mean(const WidthLine& line, double offset) const {
    std::complex<double> total = 0;
    std::size_t count = 0;
    for (std::size_t i = 0; i < classes_.size(); ++i) {
      const double inverse = 1 / (line.pitch * (classes_.depth(i) + line.depthOffset));
      for (const DepthClasses::Place& place : classes_.places(i)) {
        const double pixel = (place[k_] + offset) * inverse;
        const double angle = kTurn * (pixel - std::floor(pixel));
        total += std::complex<double>(std::cos(angle), std::sin(angle));
      }
      count += classes_.places(i).size();
    }
    return count == 0 ? 0 : total / static_cast<double>(count);
  }

  /// Climbs from there, one parameter and pairs of them at a time, with ever smaller steps.
  Result climb(double offset) const {
    const double middle = medianDepth();
    Result best{line_, offset, 0, std::abs(mean(line_, offset))};
    double byOffset = 1;
    double byDepth = 2;
    double byPitch = std::fabs(line_.pitch) * 1e-3;
    const auto consider = [&](double dOffset, double dDepth, double dPitch, bool keepMiddle) {
      Result next = best;
      next.offset += dOffset;
      next.line.depthOffset += dDepth;
      next.line.pitch += dPitch;
      if (keepMiddle) {
        next.line.pitch *= (best.line.depthOffset + middle) / (next.line.depthOffset + middle);
      }
      next.coherence = std::abs(mean(next.line, next.offset));
      if (!(next.coherence > best.coherence)) return false;
      best = next;
      return true;
    };
    constexpr int kRounds = 20;
    constexpr double kShrink = 0.6;
    for (int round = 0; round < kRounds; ++round) {
      bool improved = false;
      for (const double sign : {-1.0, 1.0}) {
        improved |= consider(sign * byOffset, 0, 0, false);
        improved |= consider(0, sign * byDepth, 0, false);
        improved |= consider(0, 0, sign * byPitch, false);
        improved |= consider(0, sign * byDepth, 0, true);
        for (const double other : {-1.0, 1.0}) {
          improved |= consider(sign * byOffset * 4, 0, other * byPitch, false);
        }
      }
      if (improved) continue;
      byOffset *= kShrink;
      byDepth *= kShrink;
      byPitch *= kShrink;
    }
    const std::complex<double> m = mean(best.line, best.offset);
    best.coherence = std::abs(m);
    best.centre = std::arg(m) / kTurn;
    return best;
  }

  double medianDepth() const {
    std::size_t count = 0;
    for (std::size_t i = 0; i < classes_.size(); ++i) {
      count += classes_.places(i).size();
      if (2 * count >= classes_.points()) return classes_.depth(i);
    }
    return 0;
  }

  const DepthClasses& classes_;
  unsigned k_;
  WidthLine line_;
  double extent_;
};

/// Fits all parameters to all points at once by Gauss–Newton steps, in turns with the shifts of the
/// depths. Points are rounded to the grid, so in the end what counts is not how far from the
/// camera's place they stand but only which of them stand more than half a step from it.
class CameraAdjustment {
 public:
  CameraAdjustment(const DepthClasses& classes, const RealCamera& start)
      : classes_(classes), camera_(start), shifts_(classes.size(), 0.0) {}

  /// From now on the centres stay where they are.
  void holdCentres() { centresHeld_ = true; }

  RealCamera run() {
    constexpr int kRounds = 6;
    constexpr int kRoundsWithTolerance = 24;
    for (int round = 0; round < kRounds + kRoundsWithTolerance; ++round) {
      tolerant_ = round >= kRounds;
      adjustCamera();
      adjustShifts();
    }
    return camera_;
  }

 private:
  static constexpr unsigned kParameters = 7;  ///< pitch, centre, offset of both axes; depthOffset
  using Row = Eigen::Matrix<double, kParameters, 1>;
  static constexpr Eigen::Index firstColumn(unsigned k) { return k == 0 ? 0 : 3; }

  /// What a point's coordinate along axis k says.
  struct Residual {
    double slope = 0;  ///< pixels from the axis
    double size = 0;   ///< of a pixel
    double value = 0;  ///< how far the point lies from where the camera would have it
    double weight = 0;
  };

  /// Calls `use` with the class and the residual of every coordinate.
  template <class Use>
  void forEach(unsigned k, Use use) const {
    constexpr double kTolerance = 0.49;
    constexpr double kWithin = 0.03;  // weight of points that are right already
    for (std::size_t i = 0; i < classes_.size(); ++i) {
      Residual r;
      r.size = camera_.pitch[k] * (classes_.depth(i) + shifts_[i] + camera_.depthOffset);
      if (!(r.size > 1)) continue;
      for (const DepthClasses::Place& place : classes_.places(i)) {
        const double x = place[k] + camera_.offset[k];
        r.slope = std::round(x / r.size - camera_.centre[k]) + camera_.centre[k];
        r.value = x - r.slope * r.size;
        r.weight = 1;
        if (tolerant_) {
          const double beyond = r.value - std::clamp(r.value, -kTolerance, kTolerance);
          if (beyond == 0) r.weight = kWithin;
          r.value = beyond;
        }
        use(i, r);
      }
    }
  }

  void adjustCamera() {
    Eigen::Matrix<double, kParameters, kParameters> a = decltype(a)::Zero();
    Row b = Row::Zero();
    for (unsigned k = 0; k < 2; ++k) {
      const Eigen::Index at = firstColumn(k);
      // The parameters of the other axis have no part in this one.
      const std::array<Eigen::Index, 4> columns = {at, at + 1, at + 2, kParameters - 1};
      forEach(k, [&](std::size_t, const Residual& r) {
        const std::array<double, 4> row = {r.slope * r.size, r.size, -1,
                                           r.slope * camera_.pitch[k]};
        for (unsigned i = 0; i < 4; ++i) {
          for (unsigned j = 0; j <= i; ++j) a(columns[i], columns[j]) += r.weight * row[i] * row[j];
          b[columns[i]] += r.weight * r.value * row[i];
        }
      });
    }
    // A breath of damping, for what points of one depth or one pixel do not tell.
    for (unsigned j = 0; j < kParameters; ++j) a(j, j) *= 1 + 1e-9;
    if (centresHeld_) {
      for (unsigned k = 0; k < 2; ++k) a(firstColumn(k) + 1, firstColumn(k) + 1) *= 1e12;
    }
    const Row step = a.selfadjointView<Eigen::Lower>().ldlt().solve(b);
    if (!step.allFinite()) return;
    for (unsigned k = 0; k < 2; ++k) {
      camera_.pitch[k] *= 1 + std::clamp(step[firstColumn(k)], -0.1, 0.1);
      if (!centresHeld_) camera_.centre[k] += step[firstColumn(k) + 1];
      camera_.offset[k] += step[firstColumn(k) + 2];
    }
    camera_.depthOffset += step[6];
  }

  /// How far each class's true depth lies from the whole step, drawn to where it was while few
  /// points tell.
  void adjustShifts() {
    constexpr double kPrior = 8;
    constexpr double kMaxShift = PinholeCamera::kMaxShift / PinholeCamera::kShiftUnit;
    std::vector<double> product(classes_.size(), 0.0);
    std::vector<double> square(classes_.size(), 0.0);
    double total = 0;
    for (unsigned k = 0; k < 2; ++k) {
      forEach(k, [&](std::size_t i, const Residual& r) {
        const double slope = r.slope * camera_.pitch[k];
        product[i] += r.weight * slope * r.value;
        square[i] += r.weight * slope * slope;
        total += r.weight * slope * slope;
      });
    }
    const double prior = kPrior * total / (static_cast<double>(classes_.points()) + 1) + 1e-12;
    for (std::size_t i = 0; i < classes_.size(); ++i) {
      const double shift = shifts_[i] + product[i] / (square[i] + prior);
      shifts_[i] = std::clamp(shift, -kMaxShift, kMaxShift);
    }
  }

  const DepthClasses& classes_;
  RealCamera camera_;
  std::vector<double> shifts_;
  bool tolerant_ = false;
  bool centresHeld_ = false;
};

/// Coordinates that a camera does not explain, a point of the sample.
double mismatchRate(const DepthClasses& classes, const RealCamera& real, unsigned axis) {
  const std::optional<PinholeCamera> camera = wholeNumbers(real, axis);
  if (!camera) return 2;
  std::size_t mismatches = 0;
  for (std::size_t i = 0; i < classes.size(); ++i) {
    const auto choice = chooseShift(*camera, classes.depth(i), classes.places(i));
    mismatches += choice ? choice->mismatches : 2 * classes.places(i).size();
  }
  return static_cast<double>(mismatches) / static_cast<double>(classes.points());
}

/// The adjusted camera; most software has the picture's centre on a pixel or between two, which is
/// taken for true if it explains the points as well.
RealCamera adjusted(const DepthClasses& classes, unsigned axis, const RealCamera& start) {
  constexpr double kNear = 0.02;
  const RealCamera found = CameraAdjustment(classes, start).run();
  RealCamera plain = found;
  for (double& c : plain.centre) {
    const double half = std::round(2 * c) / 2;
    if (std::fabs(c - half) > kNear) return found;
    c = half;
  }
  CameraAdjustment adjustment(classes, plain);
  adjustment.holdCentres();
  plain = adjustment.run();
  return mismatchRate(classes, plain, axis) <= mismatchRate(classes, found, axis) ? plain : found;
}

std::optional<PinholeCamera> findCameraAlong(Span<const GridPoint> points, unsigned axis,
                                             const GridPoint& extent) {
  constexpr std::size_t kSearchSample = 2000;
  constexpr std::size_t kFitSample = 30000;
  constexpr double kLeastCoherence = 0.5;
  constexpr double kMaxMismatches = 0.3;
  const std::optional<DepthClasses> classes = DepthClasses::of(points, axis, extent[axis]);
  if (!classes) return std::nullopt;
  std::array<std::optional<WidthLine>, 2> lines = widthLines(*classes);
  if (!lines[0] && !lines[1]) return std::nullopt;
  // Pixels are nearly square: where one direction cannot be measured, the other one's width helps.
  if (!lines[0]) lines[0] = lines[1];
  if (!lines[1]) lines[1] = lines[0];

  const DepthClasses searched = classes->sample(kSearchSample, 1);
  RealCamera camera;
  for (unsigned k = 0; k < 2; ++k) {
    const AxisSearch::Result found =
        AxisSearch(searched, k, *lines[k], extent[(axis + 1 + k) % 3]).run();
    if (found.coherence < kLeastCoherence) return std::nullopt;
    camera.pitch[k] = found.line.pitch;
    camera.depthOffset += found.line.depthOffset / 2;
    camera.offset[k] = found.offset;
    camera.centre[k] = found.centre;
  }
  const DepthClasses fitted = classes->sample(kFitSample, 4);
  camera = adjusted(fitted, axis, camera);
  if (mismatchRate(fitted, camera, axis) > kMaxMismatches) return std::nullopt;
  return wholeNumbers(camera, axis);
}

}  // namespace

std::optional<PinholeCamera> findCamera(Span<const GridPoint> points, const GridPoint& extent) {
  for (unsigned axis = 3; axis-- > 0;) {
    if (auto camera = findCameraAlong(points, axis, extent)) return camera;
  }
  return std::nullopt;
}

}  // namespace bspc::geometry::predictive
