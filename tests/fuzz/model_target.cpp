// Any bytes as a model file of each format that the command reads. The first byte chooses the
// format, the second what is done with the model.

#include <array>
#include <cstring>
#include <memory>
#include <sstream>
#include <string>
#include <utility>

#include "bspc/encoder.h"
#include "bspc/error.h"
#include "formats/model_io.h"
#include "target.h"

namespace bspc::fuzz {

namespace {

using formats::Format;
using formats::FormatError;
using formats::Model;

constexpr std::array<Format, 7> kFormats{Format::Ply, Format::Obj, Format::Off, Format::Xyz,
                                         Format::Csv, Format::Las, Format::Pcd};

// Bits of the second byte.
constexpr unsigned kWhole = 1;   ///< the model at once, then encoded and written
constexpr unsigned kArrays = 2;  ///< in pieces: arrays are wanted
constexpr unsigned kCells = 4;   ///< cells are wanted
constexpr unsigned kSlow = 8;    ///< the smallest file

void readInPieces(const std::string& file, Format format, unsigned wishes) {
  std::istringstream in(file);
  const auto stream = formats::openPointStream(in, format);
  if ((wishes & kCells) != 0) stream->keepMesh();
  if (stream->reservable() > file.size()) fail("room for more points than the file has bytes");
  const std::size_t piece = 1 + wishes / 16 * 40;
  Bytes positions(piece * 3 * 8);
  std::vector<ArrayValues> values;
  if ((wishes & kArrays) != 0) {
    for (const ArrayDescription& array : stream->info().arrays) {
      values.emplace_back();
      static_cast<ArrayDescription&>(values.back()) = array;
    }
  }
  std::size_t points = 0;
  for (std::size_t got = piece; got == piece; points += got) {
    got = stream->read(positions.data(), values, piece);
  }
  for (const ArrayValues& array : values) {
    if (array.tuples() != points) fail("an array that has not a tuple a point");
  }
  stream->takeMesh();
}

/// Any model that can be read can be encoded, or is refused for a reason that it gives.
void encodeModel(const Model& model, unsigned wishes) {
  EncodeOptions options;
  options.threads = 1;
  options.effort = (wishes & kSlow) != 0 ? 9 : 1;
  options.grid.dropNonFinite = true;
  options.grid.knownLattice = model.lattice;
  options.metadata = model.metadata;
  try {
    MemorySink sink;
    encode(model.view(), sink, options);
  } catch (const Error& error) {
    switch (error.code()) {
      case ErrorCode::Corrupt:
      case ErrorCode::Truncated:
      case ErrorCode::LimitExceeded:
      case ErrorCode::Io:
        fail("an encoder that says: " + std::string(error.what()));
      default:
        break;
    }
  }
}

/// What is written is read again, as many points and cells.
void writeModel(const Model& model, Format format) {
  std::ostringstream out;
  try {
    formats::writeModel(out, format, model.view());
  } catch (const FormatError&) {
    return;  // not every format holds every model
  }
  try {
    std::istringstream in(out.str());
    const Model again = formats::readModel(in, format, {}, true);
    if (again.size() != model.size()) fail("a written model has other points");
    // The formats of point sets leave cells out, which the command says.
    const bool holdsFaces = format == Format::Ply || format == Format::Obj || format == Format::Off;
    if (holdsFaces && again.mesh.faces.size() != model.mesh.faces.size()) {
      fail("a written model has other faces");
    }
  } catch (const FormatError& error) {
    fail("a written model that is refused: " + std::string(error.what()));
  }
}

void runModel(ByteView input) {
  if (input.size() < 2) return;
  const Format format = kFormats[input[0] % kFormats.size()];
  const unsigned wishes = input[1];
  const std::string file(input.begin() + 2, input.end());
  try {
    if ((wishes & kWhole) == 0) {
      readInPieces(file, format, wishes);
      return;
    }
    std::istringstream in(file);
    const Model model = formats::readModel(in, format, {}, (wishes & kCells) != 0);
    encodeModel(model, wishes);
    writeModel(model, kFormats[wishes / 16 % kFormats.size()]);
  } catch (const Error&) {
    return;
  } catch (const FormatError&) {
    return;
  }
}

Bytes inputOf(Format format, const std::string& file, unsigned wishes) {
  Bytes input;
  for (std::size_t i = 0; i < kFormats.size(); ++i) {
    if (kFormats[i] == format) input.push_back(static_cast<std::uint8_t>(i));
  }
  input.push_back(static_cast<std::uint8_t>(wishes));
  input.insert(input.end(), file.begin(), file.end());
  return input;
}

template <class T>
std::string bytesOf(std::initializer_list<T> numbers) {
  std::string bytes(numbers.size() * sizeof(T), '\0');
  std::memcpy(bytes.data(), numbers.begin(), bytes.size());
  return bytes;
}

std::string plyHeader(const std::string& format) {
  return "ply\nformat " + format +
         " 1.0\ncomment a scan\nelement vertex 3\nproperty float x\nproperty float y\n"
         "property float z\nproperty uchar red\nproperty list uchar short w\n"
         "element face 1\nproperty list uchar int vertex_indices\nend_header\n";
}

std::string pcdHeader(const std::string& data) {
  return "# .PCD v0.7\nVERSION 0.7\nFIELDS x y z rgb\nSIZE 4 4 4 4\nTYPE F F F U\nCOUNT 1 1 1 1\n"
         "WIDTH 1\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS 1\nDATA " +
         data + "\n";
}

/// What formats::writeModel() does not write.
std::vector<std::pair<Format, std::string>> handWritten() {
  const std::string triangle = bytesOf<std::uint8_t>({3, 0, 0, 0, 0, 1, 0, 0, 0, 2, 0, 0, 0});
  const std::string vertex = bytesOf({0.5F, 1.0F, 2.0F}) + bytesOf<std::uint8_t>({9, 1, 7, 0});
  const std::string point = bytesOf({0.5F, 1.0F, 2.0F, 3.0F});
  const std::string compressed = bytesOf<std::uint32_t>({17, 16}) + '\x0f' + point;
  return {
      {Format::Ply, plyHeader("ascii") + "0.1 2 3 255 0\n-4 +5 6e-2 0 2 7 8\n1 1 1 1 0\n3 0 1 2\n"},
      {Format::Ply, plyHeader("binary_little_endian") + vertex + vertex + vertex + triangle},
      {Format::Ply, plyHeader("binary_big_endian") + vertex + vertex + vertex + triangle},
      {Format::Obj,
       "# a\nmtllib a.mtl\no b\nv 0 0 0 1 0.5 0\nv 1.5 0 0\nv 0 1 -2e1\nvn 0 0 1\nvt 0.5 0.25\n"
       "f 1/1/1 2/1/1 3//1\nf -3 -2 -1\nl 1 2 3\np 1\ns off\nusemtl c\n"},
      {Format::Off, "OFF\n# a\n3 1 0\n0 0 0\n1 0 0\n0 1 0.5\n3 0 1 2 255 0 0\n"},
      {Format::Off, "CNOFF\n1 0 0\n0 0 0 0 0 1 0.5 0.5 0.5 1\n"},
      {Format::Xyz, "# x y z intensity\n1 2 3 4\n-5.25 6e3 7 8\n"},
      {Format::Xyz, "2\n1,2,3\n4;5;6\n"},
      {Format::Csv, "x,y,z,nx,ny,nz,name\n1,2,3,0,0,1,5\n4,5,6,1,0,0,-7.5\n"},
      {Format::Pcd, pcdHeader("ascii") + "0.1 nan 3 4278190335\n"},
      {Format::Pcd, pcdHeader("binary") + point},
      {Format::Pcd, pcdHeader("binary_compressed") + compressed},
  };
}

std::vector<Bytes> modelSeeds() {
  std::vector<Bytes> seeds;
  for (const auto& [format, text] : handWritten()) {
    seeds.push_back(inputOf(format, text, kArrays | kCells | 16));
    seeds.push_back(inputOf(format, text, kWhole | kCells));
  }
  const std::vector<double> xyz{0, 0, 0, 1.25, 0, 0, 0, 1, 0.5, 7, -8, 9.75};
  ArrayValues intensity;
  intensity.name = "intensity";
  intensity.type = ScalarType::UInt16;
  intensity.values = {1, 0, 2, 0, 3, 0, 255, 255};
  MeshCells cells;
  cells.faces.add(std::vector<std::uint32_t>{0, 1, 2});
  cells.faces.add(std::vector<std::uint32_t>{3, 2, 1});
  for (const Format format : kFormats) {
    for (const bool mesh : {false, true}) {
      PointSetView view(xyz.data(), xyz.size() / 3);
      if (mesh) view.setMesh(&cells);
      if (!mesh) view.addArray(intensity.view());
      std::ostringstream out;
      try {
        formats::writeModel(out, format, view);
      } catch (const FormatError&) {
        continue;
      }
      seeds.push_back(inputOf(format, out.str(), mesh ? kWhole | kCells | kSlow : kArrays));
    }
  }
  return seeds;
}

}  // namespace

Target modelTarget() {
  Target target;
  target.name = "model";
  target.run = runModel;
  target.seeds = modelSeeds;
  return target;
}

}  // namespace bspc::fuzz
