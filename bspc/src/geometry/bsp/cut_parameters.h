#pragma once

#include <array>
#include <cstdint>

#include "entropy/gaussian_symbols.h"
#include "entropy/symbol_coder.h"
#include "geometry/bsp/local_frame.h"
#include "geometry/stop_rule.h"

namespace bspc::geometry {

/// Bits of the three parameters of a cut plane.
struct CutBits {
  unsigned phi = 0;
  unsigned psi = 0;
  unsigned alpha = 0;
};

/// Parameters of method bsp that stand in the stream. The defaults are the paper's.
struct BspParameters {
  unsigned phiK = 3;
  unsigned psiK = 5;
  unsigned alphaK = 7;
  unsigned levelMax = 10;  ///< from this level on, planes have no bits
  /// How far rounding may have moved vertices: the encoder raises it until no point is lost.
  unsigned slackClass = 0;
  StopRule stop;

  static constexpr unsigned kFieldBits = 5;
  static constexpr unsigned kSlackBits = 3;
  static constexpr unsigned kLastSlackClass = (1U << kSlackBits) - 1;

  /// In units of 2^-kFractionBits steps; the last class distrusts vertices altogether.
  std::int64_t slack() const {
    return slackClass == kLastSlackClass ? std::int64_t{1} << 31
                                         : std::int64_t{6} << (3 * slackClass);
  }

  /// ⌊log2 n⌋ − k bits for each parameter of the cut of n points, none from levelMax on.
  CutBits bits(std::uint64_t points, unsigned level) const;

  template <class Coder>
  void code(Coder& coder) {
    const BspParameters paper;
    const bool other = phiK != paper.phiK || psiK != paper.psiK || alphaK != paper.alphaK ||
                       levelMax != paper.levelMax || slackClass != 0 || stop.lossy();
    if (coder.raw(other ? 1 : 0, 1) == 0) return;
    for (unsigned* field : {&phiK, &psiK, &alphaK, &levelMax}) {
      *field = coder.raw(*field, kFieldBits);
    }
    slackClass = coder.raw(slackClass, kSlackBits);
    stop.code(coder);
  }
};

/// A value of [−1, 1] in units of 2^-kUnitBits through the inverse quadratic map, which is finer
/// near 0: 2^bits uniform bins of t = sign(x) √|x|, each shown by x = sign(t) t² of its middle.
class InverseQuadratic {
 public:
  static constexpr unsigned kMaxBits = 16;

  /// The bin of `x`; the encoder's alone.
  static std::uint32_t bin(double x, unsigned bits);
  static std::int64_t value(std::uint32_t bin, unsigned bits);
};

/// What the encoder would like a cut plane to be, before quantisation.
struct WantedDirection {
  double sinPhi = 0;  ///< its sign is that of n · w
  double cosPsi = 0;
};

/// sin φ is clamped to ± ½ = ± 2^(kUnitBits − 1), α to 0.5 ± 0.3.
constexpr double kMaxSinPhi = 0.5;
constexpr double kAlphaReach = 0.3;

/// The direction in `frame` that belongs to the values: u cos φ + v cos ψ ± w √(sin²φ − cos²ψ).
IntegerVector planeNormal(const LocalFrame& frame, std::int64_t sinPhi, std::int64_t cosPsi);

/// The plane across `normal` (units of 2^-kUnitBits) that meets the diagonal at `alpha`.
CutPlane planeAt(const LocalFrame& frame, const IntegerVector& normal, std::int64_t alpha);

/// Codes the quantised parameters with learned models.
class CutParameterModel {
 public:
  enum Which { kPhi, kPsi, kAlpha };

  /// `x` in [−1, 1] is the encoder's; returns the dequantised one, 0 for no bits.
  template <class Coder>
  std::int64_t code(Coder& coder, Which which, unsigned bits, double x) {
    if (bits == 0) return 0;
    const std::uint32_t bin = Coder::kWriting ? InverseQuadratic::bin(x, bits) : 0;
    const unsigned leading = bits < kLearnedBits ? bits : kLearnedBits;
    const unsigned rest = bits - leading;
    entropy::GaussianSymbols& model = models_[which][leading - 1];
    if (model.empty()) model.start(1U << leading);
    const std::uint32_t high = coder.symbol(model, bin >> rest);
    const std::uint32_t low = coder.raw(bin & ((1U << rest) - 1), rest);
    return InverseQuadratic::value((high << rest) | low, bits);
  }

 private:
  static constexpr unsigned kLearnedBits = 6;
  std::array<std::array<entropy::GaussianSymbols, kLearnedBits>, 3> models_;
};

}  // namespace bspc::geometry
