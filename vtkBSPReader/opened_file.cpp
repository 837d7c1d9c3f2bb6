#include "vtkBSPReader/opened_file.h"

#include <array>
#include <vtksys/FStream.hxx>

#include "bspc/error.h"

namespace bspc::vtk {

namespace {

/// A file as a source that owns its stream. Paths are UTF-8 on every system.
class FileSource final : public ByteSource {
 public:
  explicit FileSource(const std::string& fileName) : source_(opened(stream_, fileName)) {}
  std::uint64_t size() const override { return source_.size(); }
  void read(std::uint64_t offset, Span<std::uint8_t> into) override { source_.read(offset, into); }

 private:
  /// Without a buffer: a decoder asks for whole blocks here and there, and a buffer would read what
  /// nobody asked for.
  static std::istream& opened(vtksys::ifstream& stream, const std::string& fileName) {
    stream.rdbuf()->pubsetbuf(nullptr, 0);
    stream.open(fileName.c_str(), std::ios::binary);
    if (!stream) throw Error(ErrorCode::Io, "the file " + fileName + " cannot be opened");
    return stream;
  }

  vtksys::ifstream stream_;
  StreamSource source_;
};

}  // namespace

Decoder openFile(const std::string& fileName, const OpenOptions& options) {
  return Decoder(std::make_shared<FileSource>(fileName), options);
}

Decoder openBytes(const std::string& bytes, const OpenOptions& options) {
  const auto* data = reinterpret_cast<const std::uint8_t*>(bytes.data());
  return Decoder(std::make_shared<MemorySource>(ByteView(data, bytes.size())), options);
}

bool beginsAsBspc(const std::string& fileName) {
  vtksys::ifstream stream(fileName.c_str(), std::ios::binary);
  std::array<std::uint8_t, 8> bytes{};
  stream.read(reinterpret_cast<char*>(bytes.data()), bytes.size());
  return isBspc(ByteView(bytes.data(), static_cast<std::size_t>(stream.gcount())));
}

}  // namespace bspc::vtk
