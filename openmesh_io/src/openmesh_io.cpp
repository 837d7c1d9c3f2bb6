#include "bspc/openmesh_io.h"

#include <OpenMesh/Core/IO/IOManager.hh>
#include <OpenMesh/Core/IO/reader/BaseReader.hh>
#include <OpenMesh/Core/IO/writer/BaseWriter.hh>
#include <OpenMesh/Core/System/omstream.hh>
#include <algorithm>
#include <cctype>
#include <exception>
#include <fstream>
#include <iterator>
#include <memory>

#include "bspc/decoder.h"
#include "bspc/error.h"
#include "bspc/io.h"
#include "mesh_source.h"
#include "mesh_target.h"

namespace bspc::openmesh {

namespace {

using OpenMesh::IO::BaseExporter;
using OpenMesh::IO::BaseImporter;
using OpenMesh::IO::Options;

/// "bspc", ".bspc", "mesh.BSPC": names of files, and formats of streams.
bool isBspcName(const std::string& name) {
  const std::size_t dot = name.rfind('.');
  std::string ending = dot == std::string::npos ? name : name.substr(dot + 1);
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return ending == "bspc";
}

/// Runs `work`, whose failures become false and a line in omerr().
template <class Work>
bool reportFailure(const char* who, const std::string& what, Work work) {
  try {
    work();
    return true;
  } catch (const std::exception& error) {
    omerr() << "[" << who << "] : " << what << (what.empty() ? "" : ": ") << error.what() << "\n";
    return false;
  }
}

void readFrom(std::shared_ptr<ByteSource> source, BaseImporter& importer, Options& options,
              const ReadSettings& settings) {
  OpenOptions open;
  open.limits = settings.limits;
  Decoder decoder(std::move(source), open);
  const DecodedPoints points = decoder.decode();
  // Nothing is put into the mesh before everything is known to be sound.
  MeshTarget target(importer, options);
  target.add(decoder.info().grid, points);
  options = target.found();
}

Bytes encodeMesh(BaseExporter& exporter, const Options& options, const WriteSettings& settings) {
  const MeshSource source(exporter, options);
  MemorySink sink;
  encode(source.view(), sink, settings.encoding);
  return sink.take();
}

void writeTo(std::ostream& stream, const Bytes& bytes) {
  stream.write(reinterpret_cast<const char*>(bytes.data()),
               static_cast<std::streamsize>(bytes.size()));
  stream.flush();
  if (!stream) throw Error(ErrorCode::Io, "writing failed; is there room left?");
}

class Reader final : public OpenMesh::IO::BaseReader {
 public:
  std::string get_description() const override { return "Compressed point sets and meshes"; }
  std::string get_extensions() const override { return "bspc"; }
  std::string get_magic() const override {
    return "\x8B"
           "BSP";
  }
  bool can_u_read(const std::string& filename) const override { return isBspcName(filename); }
  bool read(const std::string& filename, BaseImporter& importer, Options& options) override {
    return openmesh::read(filename, importer, options, readSettings());
  }
  bool read(std::istream& stream, BaseImporter& importer, Options& options) override {
    return openmesh::read(stream, importer, options, readSettings());
  }
};

class Writer final : public OpenMesh::IO::BaseWriter {
 public:
  std::string get_description() const override { return "Compressed point sets and meshes"; }
  std::string get_extensions() const override { return "bspc"; }
  bool can_u_write(const std::string& filename) const override { return isBspcName(filename); }
  bool write(const std::string& filename, BaseExporter& exporter, Options options,
             std::streamsize /*precision*/) const override {
    return openmesh::write(filename, exporter, options, writeSettings());
  }
  bool write(std::ostream& stream, BaseExporter& exporter, Options options,
             std::streamsize /*precision*/) const override {
    return openmesh::write(stream, exporter, options, writeSettings());
  }
  std::size_t binary_size(BaseExporter& exporter, Options options) const override {
    std::size_t size = 0;
    reportFailure("BSPCWriter", {},
                  [&] { size = encodeMesh(exporter, options, writeSettings()).size(); });
    return size;
  }
};

}  // namespace

WriteSettings& writeSettings() {
  static WriteSettings settings;
  return settings;
}

ReadSettings& readSettings() {
  static ReadSettings settings;
  return settings;
}

bool registerModule() {
  // OpenMesh's manager keeps the addresses until the program ends.
  static Reader reader;
  static Writer writer;
  static const bool kDone = OpenMesh::IO::IOManager().register_module(&reader) &&
                            OpenMesh::IO::IOManager().register_module(&writer);
  return kDone;
}

bool read(std::istream& stream, BaseImporter& importer, Options& options,
          const ReadSettings& settings) {
  return reportFailure("BSPCReader", {}, [&] {
    const std::string text((std::istreambuf_iterator<char>(stream)),
                           std::istreambuf_iterator<char>());
    const Bytes bytes(text.begin(), text.end());
    readFrom(std::make_shared<MemorySource>(bytes), importer, options, settings);
  });
}

bool read(const std::string& filename, BaseImporter& importer, Options& options,
          const ReadSettings& settings) {
  return reportFailure("BSPCReader", filename, [&] {
    std::ifstream stream(filename, std::ios::binary);
    if (!stream) throw Error(ErrorCode::Io, "the file cannot be opened for reading");
    readFrom(std::make_shared<StreamSource>(stream), importer, options, settings);
  });
}

bool write(std::ostream& stream, BaseExporter& exporter, Options options,
           const WriteSettings& settings) {
  return reportFailure("BSPCWriter", {},
                       [&] { writeTo(stream, encodeMesh(exporter, options, settings)); });
}

bool write(const std::string& filename, BaseExporter& exporter, Options options,
           const WriteSettings& settings) {
  return reportFailure("BSPCWriter", filename, [&] {
    const Bytes bytes = encodeMesh(exporter, options, settings);
    std::ofstream stream(filename, std::ios::binary);
    if (!stream) throw Error(ErrorCode::Io, "the file cannot be opened for writing");
    writeTo(stream, bytes);
  });
}

}  // namespace bspc::openmesh
