#include <memory>

#include "bspc/decoder.h"
#include "codec.h"

namespace bspc::bench {

Codec bspcCodec(const std::string& name, const EncodeOptions& options) {
  Codec codec;
  codec.name = name;
  codec.usesThreads = true;
  codec.encode = [options](const Coordinates& xyz, unsigned threads) {
    EncodeOptions threaded = options;
    threaded.threads = threads;
    MemorySink sink;
    encode(PointSetView(xyz.data(), xyz.size() / 3), sink, threaded);
    return sink.take();
  };
  codec.decode = [](const Bytes& bytes, unsigned threads) {
    Decoder decoder(std::make_shared<MemorySource>(bytes));
    DecodeOptions threaded;
    threaded.threads = threads;
    Coordinates xyz(3 * decoder.info().points);
    std::size_t at = 0;
    decoder.decodeTiles(threaded, [&](DecodedPoints&& tile) {
      restorePositions(decoder.info().grid, Span<const GridPoint>(tile.points), xyz.data() + at);
      at += 3 * tile.points.size();
    });
    return xyz;
  };
  return codec;
}

}  // namespace bspc::bench
