#include "attributes/quick_coder.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <type_traits>

namespace bspc::attributes {

namespace {

using Domain = QuickSettings::Domain;

template <class Word>
Word folded(Word residual) {
  const auto twice = static_cast<Word>(residual << 1);
  return (residual & kTopBit<Word>) != 0 ? static_cast<Word>(~twice) : twice;
}

template <class Word>
Word unfolded(Word code) {
  const auto half = static_cast<Word>(code >> 1);
  return (code & 1) != 0 ? static_cast<Word>(~half) : half;
}

/// Predicts the words of a tuple from the tuples of a window; the decoder repeats every operation.
template <class Word, Domain kDomain, bool kMean>
class QuickPredictor {
 public:
  QuickPredictor(const WindowTable& window, std::uint32_t components, NumberKind kind)
      : window_(window), components_(components), kind_(kind) {}

  void start(std::size_t i, const Word* tuple) {
    isFirst_ = i == 0;
    const auto& steps = window_.of(i);
    for (unsigned n = 0; n < WindowTable::kNeighbours; ++n) {
      near_[n] = tuple - std::size_t{steps[n]} * components_;
    }
    if constexpr (kDomain == Domain::Unit) startUnit();
  }

  std::uint32_t component(std::uint32_t i) const { return kDomain == Domain::Unit ? order_[i] : i; }

  Word predict(std::uint32_t i, const Word* tuple) const {
    if (isFirst_) return zeroWord<Word>(kind_);
    const std::uint32_t c = component(i);
    if constexpr (kDomain == Domain::Words) {
      return meanOfWords(c);
    } else if constexpr (kDomain == Domain::Numbers) {
      return wordOrNearest(meanOfNumbers(c), c);
    } else {
      if (i < 2) return wordOrNearest(expected_[c], c);
      const double a = numberOfWord(tuple[order_[0]]);
      const double b = numberOfWord(tuple[order_[1]]);
      const double rest = 1.0 - a * a - b * b;
      const double size = rest > 0 ? std::sqrt(rest) : 0.0;
      return wordOfNumber<Word>(expected_[c] < 0 ? -size : size);
    }
  }

 private:
  Word meanOfWords(std::uint32_t c) const {
    using Signed = std::make_signed_t<Word>;
    const Word base = near_[0][c];
    if constexpr (!kMean) return base;
    const std::int64_t second = static_cast<Signed>(static_cast<Word>(near_[1][c] - base));
    const std::int64_t third = static_cast<Signed>(static_cast<Word>(near_[2][c] - base));
    return static_cast<Word>(base + static_cast<Word>(((second >> 1) + (third >> 1) + 1) >> 1));
  }

  double meanOfNumbers(std::uint32_t c) const {
    const double first = numberOfWord(near_[0][c]);
    if constexpr (!kMean) return first;
    return (first + first + numberOfWord(near_[1][c]) + numberOfWord(near_[2][c])) * 0.25;
  }

  Word wordOrNearest(double number, std::uint32_t c) const {
    const auto greatest = static_cast<double>(std::numeric_limits<FloatOf<Word>>::max());
    return std::fabs(number) <= greatest ? wordOfNumber<Word>(number) : near_[0][c];
  }

  void startUnit() {
    if (isFirst_) {
      order_ = {0, 1, 2};
      return;
    }
    for (std::uint32_t c = 0; c < 3; ++c) expected_[c] = meanOfNumbers(c);
    std::uint32_t last = 0;
    for (std::uint32_t c = 1; c < 3; ++c) {
      if (std::fabs(expected_[c]) > std::fabs(expected_[last])) last = c;
    }
    order_ = {last == 0 ? 1U : 0U, last == 2 ? 1U : 2U, last};
  }

  const WindowTable& window_;
  std::uint32_t components_;
  NumberKind kind_;
  bool isFirst_ = true;
  std::array<const Word*, WindowTable::kNeighbours> near_{};
  std::array<double, 3> expected_{};
  std::array<std::uint32_t, 3> order_{};
};

/// Rows of bytes: for each component, its words' bytes, least significant first.
template <class Word>
class Rows {
 public:
  Rows(std::size_t count, std::uint32_t components)
      : count_(count), bytes_(count * components * sizeof(Word)) {}

  void put(std::size_t i, std::uint32_t component, Word word) {
    std::uint8_t* at = bytes_.data() + component * sizeof(Word) * count_ + i;
    for (std::size_t b = 0; b < sizeof(Word); ++b, at += count_) {
      *at = static_cast<std::uint8_t>(std::uint64_t{word} >> (8 * b));
    }
  }
  Word get(std::size_t i, std::uint32_t component) const {
    const std::uint8_t* at = bytes_.data() + component * sizeof(Word) * count_ + i;
    std::uint64_t word = 0;
    for (std::size_t b = 0; b < sizeof(Word); ++b, at += count_) {
      word |= std::uint64_t{*at} << (8 * b);
    }
    return static_cast<Word>(word);
  }
  std::size_t rows() const { return count_ > 0 ? bytes_.size() / count_ : 0; }
  Span<std::uint8_t> row(std::size_t r) { return {bytes_.data() + r * count_, count_}; }

 private:
  std::size_t count_;
  Bytes bytes_;
};

template <class Word, Domain kDomain, bool kMean>
void residualsOf(const WindowTable& window, const QuickSettings& settings,
                 const std::vector<Word>& words, std::size_t count, Rows<Word>& rows) {
  QuickPredictor<Word, kDomain, kMean> predictor(window, settings.components, settings.kind);
  const Word* tuple = words.data();
  for (std::size_t i = 0; i < count; ++i, tuple += settings.components) {
    predictor.start(i, tuple);
    Word before = 0;
    for (std::uint32_t k = 0; k < settings.components; ++k) {
      const auto residual =
          static_cast<Word>(tuple[predictor.component(k)] - predictor.predict(k, tuple));
      rows.put(i, k, folded(static_cast<Word>(residual - before)));
      if (settings.chained) before = residual;
    }
  }
}

template <class Word, Domain kDomain, bool kMean>
void restoreWords(const WindowTable& window, const QuickSettings& settings, const Rows<Word>& rows,
                  std::vector<Word>& words) {
  QuickPredictor<Word, kDomain, kMean> predictor(window, settings.components, settings.kind);
  Word* tuple = words.data();
  const std::size_t count = words.size() / settings.components;
  for (std::size_t i = 0; i < count; ++i, tuple += settings.components) {
    predictor.start(i, tuple);
    Word before = 0;
    for (std::uint32_t k = 0; k < settings.components; ++k) {
      const auto residual = static_cast<Word>(unfolded(rows.get(i, k)) + before);
      tuple[predictor.component(k)] = static_cast<Word>(predictor.predict(k, tuple) + residual);
      if (settings.chained) before = residual;
    }
  }
}

/// Calls f with the settings' domain and mean as compile-time constants.
template <class Word, class F>
void withSettings(const QuickSettings& settings, F&& f) {
  const auto withMean = [&](auto domain) {
    if (settings.mean) {
      f(domain, std::true_type{});
    } else {
      f(domain, std::false_type{});
    }
  };
  if constexpr (sizeof(Word) >= 4) {
    if (settings.domain == Domain::Numbers) {
      return withMean(std::integral_constant<Domain, Domain::Numbers>{});
    }
    if (settings.domain == Domain::Unit) {
      return withMean(std::integral_constant<Domain, Domain::Unit>{});
    }
  }
  withMean(std::integral_constant<Domain, Domain::Words>{});
}

}  // namespace

template <class Word>
void writeQuick(const WindowTable& window, const QuickSettings& settings,
                const std::vector<Word>& words, std::size_t limit, PlaneWriter& planes,
                container::ByteWriter& out) {
  const std::size_t count = std::min(limit, words.size() / settings.components);
  Rows<Word> rows(count, settings.components);
  withSettings<Word>(settings, [&](auto domain, auto mean) {
    residualsOf<Word, decltype(domain)::value, decltype(mean)::value>(window, settings, words,
                                                                      count, rows);
  });
  for (std::size_t r = 0; r < rows.rows(); ++r) planes.write(rows.row(r), out);
}

template <class Word>
void readQuick(container::ByteReader& in, const WindowTable& window, const QuickSettings& settings,
               std::vector<Word>& words) {
  Rows<Word> rows(words.size() / settings.components, settings.components);
  PlaneReader planes;
  for (std::size_t r = 0; r < rows.rows(); ++r) planes.read(in, rows.row(r));
  withSettings<Word>(settings, [&](auto domain, auto mean) {
    restoreWords<Word, decltype(domain)::value, decltype(mean)::value>(window, settings, rows,
                                                                       words);
  });
}

#define BSPC_INSTANTIATE(Word)                                                                    \
  template void writeQuick<Word>(const WindowTable&, const QuickSettings&,                        \
                                 const std::vector<Word>&, std::size_t, PlaneWriter&,             \
                                 container::ByteWriter&);                                         \
  template void readQuick<Word>(container::ByteReader&, const WindowTable&, const QuickSettings&, \
                                std::vector<Word>&);
BSPC_INSTANTIATE(std::uint8_t)
BSPC_INSTANTIATE(std::uint16_t)
BSPC_INSTANTIATE(std::uint32_t)
BSPC_INSTANTIATE(std::uint64_t)
#undef BSPC_INSTANTIATE

}  // namespace bspc::attributes
