#include "attributes/residual_coder.h"

#include <algorithm>
#include <array>
#include <type_traits>

#include "attributes/residual_models.h"
#include "attributes/tuple_predictor.h"

namespace bspc::attributes {

namespace {

/// Codes tuples with a SymbolWriter or a SymbolReader.
template <class Coder, class Word>
class ResidualCoder {
 public:
  ResidualCoder(Coder& coder, const RankedPoints& points, const NeighbourTable& neighbours,
                const ResidualSettings& settings, std::vector<Word>& words)
      : coder_(coder),
        points_(points),
        neighbours_(neighbours),
        settings_(settings),
        words_(words),
        weights_(points, settings.predictor, settings.stiffness),
        predictor_(settings, words),
        models_(8 * sizeof(Word), settings.components),
        sizes_((points.size() - points.known) * settings.components),
        negative_(sizes_.size()) {
    for (std::size_t rank = 0; rank < points.known; ++rank) predictor_.learn(rank);
  }

  void run(std::size_t limit) {
    const std::size_t end = points_.known + std::min(limit, points_.size() - points_.known);
    for (std::size_t rank = points_.known; rank < end; ++rank) codeTuple(rank);
  }

 private:
  void codeTuple(std::size_t rank) {
    weights_.find(static_cast<std::uint32_t>(rank), neighbours_.of(rank), near_);
    predictor_.start(near_);
    Word* tuple = words_.data() + rank * settings_.components;
    if (settings_.domain != ResidualSettings::Domain::Sphere) {
      codeWords(rank, tuple);
    } else {
      std::array<Word, 2> coded{};
      if (Coder::kWriting) coded = predictor_.toChart(tuple);
      codeWords(rank, coded.data());
      if (!Coder::kWriting) {
        coded = predictor_.fromChart(coded.data());
        std::copy(coded.begin(), coded.end(), tuple);
      }
    }
    predictor_.learn(rank);
  }

  void codeWords(std::size_t rank, Word* tuple) {
    const std::size_t first = (rank - points_.known) * settings_.components;
    unsigned surprise = 0;
    unsigned lastSign = 1;
    for (std::uint32_t i = 0; i < settings_.components; ++i) {
      const std::uint32_t component = predictor_.component(i);
      const Word prediction = predictor_.predict(i, tuple);
      ResidualContext context = contextOf(i);
      context.surprise = surprise;
      context.signs = 3 * context.signs + lastSign;
      const auto residual = codeWord(tuple[component], prediction, context);
      sizes_[first + i] = static_cast<Word>(residual.size);
      negative_[first + i] = residual.negative ? 1 : 0;
      surprise = surpriseOf(residual.size, context.expected);
      lastSign = residual.size == 0 ? 1 : residual.negative ? 0 : 2;
    }
  }

  using Models = ResidualModels<Coder>;

  typename Models::Residual codeWord(Word& word, Word prediction, const ResidualContext& context) {
    typename Models::Residual residual;
    if (Coder::kWriting) {
      const auto difference = static_cast<Word>(word - prediction);
      residual.negative = (difference & kTopBit<Word>) != 0;
      residual.size = residual.negative ? static_cast<Word>(Word{0} - difference) : difference;
    }
    residual = models_.code(coder_, residual, context);
    if (!Coder::kWriting) {
      const auto size = static_cast<Word>(residual.size);
      word = static_cast<Word>(residual.negative ? prediction - size : prediction + size);
    }
    return residual;
  }

  /// What the neighbours' residuals tell; context.signs is that of the nearest one, 0 to 2.
  ResidualContext contextOf(std::uint32_t i) const {
    constexpr std::uint64_t kGreatestSize = std::uint64_t{1} << 58;  // so that sums fit
    ResidualContext context;
    context.slot = std::min(i, kSlots - 1);
    context.signs = 1;
    std::uint64_t sum = 0;
    std::uint64_t count = 0;
    for (const std::uint32_t rank : near_.ranks) {
      if (rank < points_.known) continue;
      const std::size_t at = (rank - points_.known) * settings_.components + i;
      const std::uint64_t size = sizes_[at];
      if (count == 0 && size > 0) context.signs = negative_[at] != 0 ? 0 : 2;
      sum += std::min(size, kGreatestSize);
      ++count;
    }
    context.expected = count > 0 ? halfOctave(2 * sum / count) : 0;
    return context;
  }

  static unsigned surpriseOf(std::uint64_t size, unsigned expected) {
    constexpr int kMiddle = 4;
    const int difference = static_cast<int>(halfOctave(2 * size)) - static_cast<int>(expected);
    return static_cast<unsigned>(std::clamp(difference / 2 + kMiddle, 1, 7));
  }

  Coder& coder_;
  const RankedPoints& points_;
  const NeighbourTable& neighbours_;
  const ResidualSettings& settings_;
  std::vector<Word>& words_;
  PredictionWeights weights_;
  TuplePredictor<Word> predictor_;
  Models models_;
  WeightedNeighbours near_;
  std::vector<Word> sizes_;  ///< of the residuals of new points
  std::vector<std::uint8_t> negative_;
};

}  // namespace

template <class Word>
Bytes writeResiduals(const RankedPoints& points, const NeighbourTable& neighbours,
                     const ResidualSettings& settings, std::vector<Word>& words,
                     std::size_t limit) {
  entropy::SymbolWriter writer;
  ResidualCoder<entropy::SymbolWriter, Word>(writer, points, neighbours, settings, words)
      .run(limit);
  return writer.finish();
}

template <class Word>
void readResiduals(ByteView stream, const RankedPoints& points, const NeighbourTable& neighbours,
                   const ResidualSettings& settings, std::vector<Word>& words) {
  entropy::SymbolReader reader(stream);
  ResidualCoder<entropy::SymbolReader, Word>(reader, points, neighbours, settings, words)
      .run(points.size());
  reader.finish();
}

#define BSPC_INSTANTIATE(Word)                                                                   \
  template Bytes writeResiduals<Word>(const RankedPoints&, const NeighbourTable&,                \
                                      const ResidualSettings&, std::vector<Word>&, std::size_t); \
  template void readResiduals<Word>(ByteView, const RankedPoints&, const NeighbourTable&,        \
                                    const ResidualSettings&, std::vector<Word>&);
BSPC_INSTANTIATE(std::uint8_t)
BSPC_INSTANTIATE(std::uint16_t)
BSPC_INSTANTIATE(std::uint32_t)
BSPC_INSTANTIATE(std::uint64_t)
#undef BSPC_INSTANTIATE

}  // namespace bspc::attributes
