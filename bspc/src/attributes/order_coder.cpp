#include "attributes/order_coder.h"

#include <algorithm>
#include <numeric>
#include <string>

#include "attributes/memory_budget.h"
#include "attributes/path_coder.h"
#include "attributes/unused_set.h"
#include "bspc/error.h"
#include "container/byte_reader.h"
#include "container/byte_writer.h"
#include "entropy/symbol_coder.h"

namespace bspc::attributes {

namespace {

/// How a permutation is coded: the low half of a payload's first byte, the version in the high one.
enum class OrderMethod : std::uint8_t {
  Identity = 0,
  Uniform = 1,  ///< any of the points left, all equally likely
  Path = 2,
};
constexpr unsigned kMethodBits = 4;

constexpr unsigned kMostMomentum = 2;
constexpr unsigned kLeastCoarser = 1;
constexpr unsigned kMostCoarser = 4;

/// Codes path[t], the point of input index t, as its rank among the points left.
template <class Coder>
void codeUniform(Coder& coder, std::vector<std::uint32_t>& path) {
  UnusedSet unused(path.size());
  for (std::uint32_t& point : path) {
    std::size_t rank = Coder::kWriting ? unused.rank(point) : 0;
    rank = coder.uniform(static_cast<std::uint32_t>(rank),
                         static_cast<std::uint32_t>(unused.size() - 1));
    point = static_cast<std::uint32_t>(unused.select(rank));
    unused.take(point);
  }
}

/// place[order[i]] = i. Throws unless `order` is a permutation.
std::vector<std::uint32_t> inverse(Span<const std::uint32_t> order) {
  constexpr std::uint32_t kNone = ~std::uint32_t{0};
  std::vector<std::uint32_t> result(order.size(), kNone);
  for (std::size_t i = 0; i < order.size(); ++i) {
    if (order[i] >= order.size() || result[order[i]] != kNone) {
      throw Error(ErrorCode::InvalidArgument, "the order of the points is not a permutation: " +
                                                  std::to_string(order[i]) + " is out of place");
    }
    result[order[i]] = static_cast<std::uint32_t>(i);
  }
  return result;
}

Bytes pathPayload(const RankedPoints& points, const PathSettings& settings,
                  std::vector<std::uint32_t>& path, std::size_t limit) {
  container::ByteWriter out;
  out.u8(static_cast<unsigned>(OrderMethod::Path));
  out.u8(settings.momentum | settings.coarser << 2);
  out.bytes(writePath(points, settings, path, limit));
  return out.take();
}

/// The best settings for the beginning of the path.
PathSettings chooseSettings(const RankedPoints& points, std::vector<std::uint32_t>& path) {
  constexpr std::size_t kSample = 16384;
  PathSettings best;
  std::size_t least = ~std::size_t{0};
  const auto tryOut = [&](PathSettings settings) {
    const std::size_t size = pathPayload(points, settings, path, kSample).size();
    if (size >= least) return;
    least = size;
    best = settings;
  };
  for (unsigned momentum = 0; momentum <= kMostMomentum; ++momentum) tryOut({momentum, 1});
  tryOut({best.momentum, 3});
  return best;
}

Bytes uniformPayload(std::vector<std::uint32_t>& path) {
  entropy::SymbolWriter writer;
  codeUniform(writer, path);
  container::ByteWriter out;
  out.u8(static_cast<unsigned>(OrderMethod::Uniform));
  out.bytes(writer.finish());
  return out.take();
}

RankedPoints rankedFor(Span<const GridPoint> points, MemoryBudget& budget) {
  constexpr std::uint64_t kBytes = 160;  // ranks, both sets of cells, the path
  budget.take(points.size(), kBytes);
  return rankPoints(points, 0);
}

}  // namespace

Bytes encodeOrder(Span<const GridPoint> points, Span<const std::uint32_t> order) {
  if (order.size() != points.size()) {
    throw Error(ErrorCode::InvalidArgument, "an order of " + std::to_string(order.size()) +
                                                " indices was given for " +
                                                std::to_string(points.size()) + " points");
  }
  std::vector<std::uint32_t> pointOfInput = inverse(order);
  if (std::is_sorted(order.begin(), order.end())) {
    return order.empty() ? Bytes{} : Bytes{static_cast<std::uint8_t>(OrderMethod::Identity)};
  }
  MemoryBudget budget = MemoryBudget::unlimited();
  const RankedPoints ranked = rankedFor(points, budget);
  const std::vector<std::uint32_t> rankOfIndex = inverse(ranked.indexOfRank);
  std::vector<std::uint32_t> path(points.size());
  for (std::size_t t = 0; t < path.size(); ++t) path[t] = rankOfIndex[pointOfInput[t]];
  Bytes best = uniformPayload(pointOfInput);
  Bytes followed = pathPayload(ranked, chooseSettings(ranked, path), path, path.size());
  return followed.size() < best.size() ? followed : best;
}

std::vector<std::uint32_t> decodeOrder(Span<const GridPoint> points, ByteView payload,
                                       std::uint64_t maxBytes) {
  container::ByteReader in(payload, "the order of the points", container::ByteReader::kNoOffset);
  if (points.empty()) {
    in.expectEnd();
    return {};
  }
  MemoryBudget budget(maxBytes);
  budget.take(points.size(), 2 * sizeof(std::uint32_t));
  const unsigned byte = in.u8();
  const auto method = static_cast<OrderMethod>(byte & ((1U << kMethodBits) - 1));
  if (byte > static_cast<unsigned>(OrderMethod::Path)) {
    throw Error(ErrorCode::Unsupported,
                "the order of the points is coded with method " +
                    std::to_string(byte & ((1U << kMethodBits) - 1)) + ", version " +
                    std::to_string(byte >> kMethodBits) +
                    ", which this version of bspc does not know; a newer one may");
  }
  std::vector<std::uint32_t> path(points.size());
  if (method == OrderMethod::Identity) {
    in.expectEnd();
    std::iota(path.begin(), path.end(), 0U);
    return path;
  }
  if (method == OrderMethod::Uniform) {
    entropy::SymbolReader reader(in.bytes(in.remaining()));
    codeUniform(reader, path);
    reader.finish();
    return inverse(path);
  }
  const unsigned packed = in.u8();
  const PathSettings settings{packed & 3, packed >> 2};
  if (settings.momentum > kMostMomentum || settings.coarser < kLeastCoarser ||
      settings.coarser > kMostCoarser) {
    in.fail("the settings of the path are out of range");
  }
  const RankedPoints ranked = rankedFor(points, budget);
  path = readPath(in.bytes(in.remaining()), ranked, settings);
  std::vector<std::uint32_t> order(points.size());
  for (std::size_t t = 0; t < path.size(); ++t) {
    order[ranked.indexOfRank[path[t]]] = static_cast<std::uint32_t>(t);
  }
  return order;
}

}  // namespace bspc::attributes
