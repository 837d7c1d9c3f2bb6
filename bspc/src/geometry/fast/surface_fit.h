#pragma once

// The encoder's choice of surfaces, for one instruction set.

#include <algorithm>
#include <cmath>
#include <cstring>

#include "entropy/lane_set.h"
#include "geometry/fast/chunk_coder.h"
#include "geometry/fast/fit_options.h"

namespace bspc::geometry::fast {
inline namespace BSPC_LANE_SET {

namespace fit {

constexpr std::size_t kLanes = 8;  ///< partial sums, so that compilers may use vectors
constexpr std::size_t kTerms = 6;  ///< 1, X, Y, X², XY, Y²
static_assert(kChunkPoints % kLanes == 0, "whole vectors only");

/// log2 of a positive number, to about 0.01.
inline float roughLog2(float value) {
  std::uint32_t bits = 0;
  std::memcpy(&bits, &value, sizeof bits);
  const std::uint32_t mantissaBits = (bits & 0x7FFFFFU) | 0x3F800000U;
  float m = 0;
  std::memcpy(&m, &mantissaBits, sizeof m);
  const auto exponent = static_cast<float>(static_cast<int>(bits >> 23) - 127);
  return exponent + ((-0.33582878F * m + 2.0F) * m - 1.66417122F);
}

inline float sum(const float (&lanes)[kLanes]) {
  return ((lanes[0] + lanes[4]) + (lanes[1] + lanes[5])) +
         ((lanes[2] + lanes[6]) + (lanes[3] + lanes[7]));
}

using Values = float[kChunkPoints];

/// Sum of log2(scale · value + 1); entries past the count must be 0.
inline float sumOfLogs(const Values& values, float scale) {
  float lanes[kLanes] = {};
  for (std::size_t i = 0; i < kChunkPoints; i += kLanes) {
    for (std::size_t j = 0; j < kLanes; ++j) {
      lanes[j] += roughLog2(scale * std::fabs(values[i + j]) + 1.0F);
    }
  }
  return sum(lanes);
}

inline unsigned classOf(float logs, std::size_t count, const ValueClasses& classes) {
  const float cls = 2 * logs / static_cast<float>(count) + 0.35F;
  return cls <= 0 ? 0 : std::min(static_cast<unsigned>(cls), classes.last());
}

/// The chunk in floating point, centred; points past the count lie at the centre.
struct Samples {
  Values x;
  Values y;
  Values z;
  std::uint32_t level = 0;  ///< subtracted from heights
};

struct Moments {
  enum { kSums = 20 };
  float s[kSums];  ///< x y xx xy yy xxx xxy xyy yyy xxxx xxxy xxyy xyyy yyyy z zx zy zxx zxy zyy
};

inline Samples samplesOf(Chunk& chunk) {
  Samples s;
  std::uint64_t total = 0;
  for (std::size_t i = 0; i < chunk.count; ++i) total += chunk.w[i];
  s.level = static_cast<std::uint32_t>(total / chunk.count);
  for (std::size_t i = chunk.count; i < kChunkPoints; ++i) {
    chunk.u[i] = chunk.footprint.centre[0];
    chunk.v[i] = chunk.footprint.centre[1];
    chunk.w[i] = s.level;
  }
  constexpr float kScale = 1.0F / (1U << kNormalBits);
  const Footprint f = chunk.footprint;
  for (std::size_t i = 0; i < kChunkPoints; ++i) {
    chunk.x[i] = f.normal(0, chunk.u[i]);
    chunk.y[i] = f.normal(1, chunk.v[i]);
    s.x[i] = static_cast<float>(chunk.x[i]) * kScale;
    s.y[i] = static_cast<float>(chunk.y[i]) * kScale;
    s.z[i] = static_cast<float>(static_cast<std::int32_t>(chunk.w[i] - s.level));
  }
  return s;
}

inline Moments momentsOf(const Samples& s) {
  float lanes[Moments::kSums][kLanes] = {};
  for (std::size_t i = 0; i < kChunkPoints; i += kLanes) {
    for (std::size_t j = 0; j < kLanes; ++j) {
      const float x = s.x[i + j];
      const float y = s.y[i + j];
      const float z = s.z[i + j];
      const float xx = x * x;
      const float xy = x * y;
      const float yy = y * y;
      lanes[0][j] += x;
      lanes[1][j] += y;
      lanes[2][j] += xx;
      lanes[3][j] += xy;
      lanes[4][j] += yy;
      lanes[5][j] += xx * x;
      lanes[6][j] += xx * y;
      lanes[7][j] += x * yy;
      lanes[8][j] += yy * y;
      lanes[9][j] += xx * xx;
      lanes[10][j] += xx * xy;
      lanes[11][j] += xx * yy;
      lanes[12][j] += xy * yy;
      lanes[13][j] += yy * yy;
      lanes[14][j] += z;
      lanes[15][j] += z * x;
      lanes[16][j] += z * y;
      lanes[17][j] += z * xx;
      lanes[18][j] += z * xy;
      lanes[19][j] += z * yy;
    }
  }
  Moments m;
  for (std::size_t t = 0; t < Moments::kSums; ++t) m.s[t] = sum(lanes[t]);
  return m;
}

/// Solves the leading n × n normal equations by Cholesky; false if they are singular.
template <std::size_t N>
inline bool solve(float (&a)[kTerms][kTerms], float (&b)[kTerms]) {
  float inverse[N];
  for (std::size_t i = 0; i < N; ++i) {
    float d = a[i][i];
    for (std::size_t k = 0; k < i; ++k) d -= a[i][k] * a[i][k];
    if (!(d > 1e-9F)) return false;
    inverse[i] = 1 / std::sqrt(d);
    for (std::size_t j = i + 1; j < N; ++j) {
      float s = a[j][i];
      for (std::size_t k = 0; k < i; ++k) s -= a[j][k] * a[i][k];
      a[j][i] = s * inverse[i];
    }
  }
  for (std::size_t i = 0; i < N; ++i) {
    float s = b[i];
    for (std::size_t k = 0; k < i; ++k) s -= a[i][k] * b[k];
    b[i] = s * inverse[i];
  }
  for (std::size_t i = N; i-- > 0;) {
    float s = b[i];
    for (std::size_t k = i + 1; k < N; ++k) s -= a[k][i] * b[k];
    b[i] = s * inverse[i];
  }
  return true;
}

/// Least squares with a slight pull towards level surfaces, which costs nothing where the points
/// say more and keeps parameters small where they do not.
inline bool leastSquares(const Moments& m, std::size_t count, SurfaceMode mode,
                         float (&b)[kTerms]) {
  const auto n = static_cast<float>(count);
  const float ridge = 0.0001F * n;
  const float* s = m.s;
  float a[kTerms][kTerms] = {{n, 0, 0, 0, 0, 0},
                             {s[0], s[2] + ridge, 0, 0, 0, 0},
                             {s[1], s[3], s[4] + ridge, 0, 0, 0},
                             {s[2], s[5], s[6], s[9] + ridge, 0, 0},
                             {s[3], s[6], s[7], s[10], s[11] + ridge, 0},
                             {s[4], s[7], s[8], s[11], s[12], s[13] + ridge}};
  std::copy(s + 14, s + 20, b);
  const std::size_t terms = mode == SurfaceMode::Constant ? 1 : mode == SurfaceMode::Plane ? 3 : 6;
  const bool solved = mode == SurfaceMode::Constant ? solve<1>(a, b)
                      : mode == SurfaceMode::Plane  ? solve<3>(a, b)
                                                    : solve<6>(a, b);
  std::fill(b + terms, b + kTerms, 0.0F);
  return solved;
}

/// Estimated magnitudes of the residuals that a fit leaves.
inline void residualsOf(const Samples& s, std::size_t count, const float (&b)[kTerms], bool filter,
                        Values& e) {
  float r[kChunkPoints + 2];
  r[0] = r[1] = 0;
  for (std::size_t i = 0; i < kChunkPoints; ++i) {
    const float x = s.x[i];
    const float y = s.y[i];
    r[i + 2] = s.z[i] - (b[0] + b[1] * x + b[2] * y + b[3] * x * x + b[4] * x * y + b[5] * y * y);
  }
  const float f1 = filter ? kFilter1 / 128.0F : 0;
  const float f2 = filter ? kFilter2 / 128.0F : 0;
  for (std::size_t i = 0; i < kChunkPoints; ++i) {
    e[i] = std::fabs(r[i + 2] - f1 * r[i + 1] - f2 * r[i]);
  }
  std::fill(e + count, e + kChunkPoints, 0.0F);
}

/// Bits of a parameter's difference.
inline float fieldBits(std::int64_t difference) {
  return 0.5F + roughLog2(2.0F * std::fabs(static_cast<float>(difference)) + 1);
}

inline Surface quantised(const float (&b)[kTerms], const Samples& samples, const Moments& m,
                         std::size_t count, SurfaceMode mode, int precision) {
  Surface s;
  s.mode = mode;
  s.precision = precision;
  const float unit = std::ldexp(0.125F, precision);
  const auto rounded = [](float v) {
    return static_cast<std::int64_t>(std::lrint(std::clamp(v, -30000.0F, 30000.0F)));
  };
  if (mode != SurfaceMode::Constant) {
    for (unsigned k = 0; k < 2; ++k) s.slope[k] = rounded(b[1 + k] / unit * 0.5F);
  }
  if (mode == SurfaceMode::Quadric) {
    for (unsigned k = 0; k < 3; ++k) s.bend[k] = rounded(b[3 + k] / unit * 0.25F);
  }
  // The height is chosen last: it makes up for what rounding did to the mean.
  double others = 0;
  for (unsigned k = 0; k < 2; ++k) others += 2.0 * static_cast<double>(s.slope[k]) * m.s[k];
  for (unsigned k = 0; k < 3; ++k) others += 4.0 * static_cast<double>(s.bend[k]) * m.s[2 + k];
  const double height =
      (m.s[14] - others * unit) / static_cast<double>(count) + static_cast<double>(samples.level);
  s.height = std::llrint(height / unit);
  return s;
}

struct Candidate {
  Surface surface;
  unsigned residualClass = 0;
  float cost = 0;
};

inline Candidate deltas(const Chunk& chunk, std::uint32_t lastHeight) {
  Values e = {};
  std::uint32_t before = lastHeight;
  for (std::size_t i = 0; i < chunk.count; ++i) {
    e[i] = static_cast<float>(static_cast<std::int32_t>(chunk.w[i] - before));
    before = chunk.w[i];
  }
  Candidate c;
  const float logs = sumOfLogs(e, 2);
  c.residualClass = classOf(logs, chunk.count, kResidualClasses);
  c.cost = logs + 1;
  return c;
}

inline bool trySurface(const Chunk& chunk, const Samples& samples, const Moments& m,
                       SurfaceMode mode, const SurfaceHistory& history, Candidate& c) {
  float b[kTerms];
  if (!leastSquares(m, chunk.count, mode, b)) return false;
  Values e;
  residualsOf(samples, chunk.count, b, mode != SurfaceMode::Constant, e);
  const float logs = sumOfLogs(e, 2);
  c.residualClass = classOf(logs, chunk.count, kResidualClasses);
  c.surface = quantised(b, samples, m, chunk.count, mode, precisionOf(c.residualClass));
  const Surface expected = history.expected(chunk.footprint, c.surface.precision);
  c.cost = logs + fieldBits(c.surface.height - expected.height) + 1;
  if (mode == SurfaceMode::Constant) return true;
  for (unsigned k = 0; k < 2; ++k) {
    c.cost += fieldBits(c.surface.slope[k] - expected.slope[k]);
  }
  if (mode == SurfaceMode::Quadric) {
    for (const std::int64_t bend : c.surface.bend) c.cost += fieldBits(bend);
  }
  return true;
}

}  // namespace fit

/// Sets the residuals of the chunk's surface.
inline void setResiduals(Chunk& chunk, std::uint32_t lastHeight) {
  if (chunk.surface.mode == SurfaceMode::Delta) {
    for (std::size_t i = 0; i < chunk.count; ++i) {
      chunk.residuals[i] = zigzag32(chunk.w[i] - lastHeight);
      lastHeight = chunk.w[i];
    }
    return;
  }
  Chunk::PerPoint<std::uint32_t> heights;
  evaluate(chunk.surface, chunk.x.data(), chunk.y.data(), chunk.count, heights.data());
  if (chunk.surface.mode == SurfaceMode::Constant) {
    for (std::size_t i = 0; i < chunk.count; ++i) {
      chunk.residuals[i] = zigzag32(chunk.w[i] - heights[i]);
    }
    return;
  }
  std::uint32_t last = 0;
  std::uint32_t beforeLast = 0;
  for (std::size_t i = 0; i < chunk.count; ++i) {
    const std::uint32_t residual = chunk.w[i] - heights[i];
    chunk.residuals[i] = zigzag32(residual - filtered(last, beforeLast));
    beforeLast = last;
    last = residual;
  }
}

/// Chooses mode, class and surface of a chunk whose u, v, w are set, and sets its residuals.
/// Returns an estimate of the bits that its heights take.
inline float fitSurface(Chunk& chunk, const SurfaceHistory& history, std::uint32_t lastHeight,
                        const FitOptions& options) {
  fit::Candidate best = fit::deltas(chunk, lastHeight);
  if (chunk.count >= 4) {
    chunk.footprint = Footprint::of(chunk.u.data(), chunk.v.data(), chunk.count);
    const fit::Samples samples = fit::samplesOf(chunk);
    const fit::Moments moments = fit::momentsOf(samples);
    const auto consider = [&](SurfaceMode mode) {
      fit::Candidate c;
      const bool solved = fit::trySurface(chunk, samples, moments, mode, history, c);
      if (solved && c.cost < best.cost) best = c;
      return solved ? c.cost : 0;
    };
    if (chunk.count < 12) consider(SurfaceMode::Constant);
    const float planeCost = chunk.count >= 5 ? consider(SurfaceMode::Plane) : 0;
    // Where a plane is far worse than no surface at all, a quadric is hardly better.
    const bool hopeless = best.residualClass <= 1 || (best.surface.mode == SurfaceMode::Delta &&
                                                      best.cost * 1.15F < planeCost);
    if (options.quadrics && chunk.count >= 14 && !hopeless) consider(SurfaceMode::Quadric);
  }
  chunk.surface = best.surface;
  chunk.residualClass = best.residualClass;
  return best.cost + 1.5F * static_cast<float>(chunk.count);
}

/// Class of gaps; also returns an estimate of their bits.
inline float chooseGapClass(Chunk& chunk) {
  fit::Values gaps = {};
  for (std::size_t i = 0; i < chunk.count; ++i) gaps[i] = static_cast<float>(chunk.gaps[i]);
  const float logs = fit::sumOfLogs(gaps, 1);
  chunk.gapClass = fit::classOf(logs, chunk.count, kGapClasses);
  return logs + 2.0F * static_cast<float>(chunk.count);
}

}  // namespace BSPC_LANE_SET
}  // namespace bspc::geometry::fast
