// Sizes of whole meshes beside those of Draco's Edgebreaker, both at 12 bits (draco_encoder -qp 12
// -cl 10): run draco_mesh_benchmark [--positions-first] FILE.off...
//
// bspc codes a mesh the shorter way: faces from the positions, or positions along the faces (an
// asterisk; the faces then stand among the rest). --positions-first leaves it the first way only.
// Both get the same positions and faces, as OFF files of triangles have them (polygons are cut into
// fans, as Draco holds triangles only). A line tells bytes of positions and of faces of either, and
// whether Draco kept all vertices and faces: it merges points at the same place and drops faces
// without area. bspc's files are decoded and compared.

#include <draco/compression/decode.h>
#include <draco/compression/encode.h>
#include <draco/compression/mesh/mesh_edgebreaker_encoder.h>
#include <draco/mesh/mesh.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "bspc/decoder.h"
#include "bspc/encoder.h"
#include "off_model.h"

namespace bspc {
namespace {

constexpr unsigned kBits = 12;
constexpr unsigned kMostEffort = 9;

using bench::OffModel;

struct Sizes {
  std::size_t whole = 0;
  std::size_t faces = 0;
  bool kept = true;
  bool alongFaces = false;
};

/// Tells how many bytes the connectivity takes.
class MeasuringEncoder : public draco::MeshEdgebreakerEncoder {
 public:
  std::size_t connectivity() const { return connectivity_; }

 protected:
  draco::Status EncodeConnectivity() override {
    const std::size_t before = buffer()->size();
    const draco::Status status = MeshEdgebreakerEncoder::EncodeConnectivity();
    connectivity_ = buffer()->size() - before;
    return status;
  }

 private:
  std::size_t connectivity_ = 0;
};

std::unique_ptr<draco::Mesh> dracoMesh(const OffModel& model) {
  auto mesh = std::make_unique<draco::Mesh>();
  const auto count = static_cast<std::uint32_t>(model.points());
  mesh->set_num_points(count);
  draco::GeometryAttribute position;
  position.Init(draco::GeometryAttribute::POSITION, nullptr, 3, draco::DT_FLOAT32, false,
                3 * sizeof(float), 0);
  const int id = mesh->AddAttribute(position, true, count);
  for (std::uint32_t i = 0; i < count; ++i) {
    mesh->attribute(id)->SetAttributeValue(draco::AttributeValueIndex(i), &model.xyz[3 * i]);
  }
  mesh->SetNumFaces(model.cells.faces.size());
  for (std::uint32_t i = 0; i < model.cells.faces.size(); ++i) {
    draco::Mesh::Face face;
    for (unsigned j = 0; j < 3; ++j) face[j] = draco::PointIndex(model.cells.faces[i][j]);
    mesh->SetFace(draco::FaceIndex(i), face);
  }
  // As the program draco_encoder does.
  mesh->DeduplicateAttributeValues();
  mesh->DeduplicatePointIds();
  return mesh;
}

Sizes withDraco(const OffModel& model) {
  const std::unique_ptr<draco::Mesh> mesh = dracoMesh(model);
  draco::EncoderOptions options = draco::EncoderOptions::CreateDefaultOptions();
  options.SetSpeed(0, 0);
  options.SetAttributeInt(0, "quantization_bits", static_cast<int>(kBits));
  MeasuringEncoder encoder;
  encoder.SetMesh(*mesh);
  draco::EncoderBuffer buffer;
  const draco::Status status = encoder.Encode(options, &buffer);
  if (!status.ok()) throw std::runtime_error("Draco: " + status.error_msg_string());
  draco::DecoderBuffer in;
  in.Init(buffer.data(), buffer.size());
  auto decoded = draco::Decoder().DecodeMeshFromBuffer(&in);
  if (!decoded.ok()) throw std::runtime_error("Draco: " + decoded.status().error_msg_string());
  const draco::Mesh& back = *decoded.value();
  return {buffer.size(), encoder.connectivity(),
          back.num_faces() == model.cells.faces.size() && back.num_points() == model.points(),
          false};
}

std::vector<std::array<std::uint64_t, 3>> sortedFaces(const Cells& faces,
                                                      const std::vector<std::uint64_t>& order) {
  std::vector<std::array<std::uint64_t, 3>> result;
  for (std::size_t i = 0; i < faces.size(); ++i) {
    std::array<std::uint64_t, 3> face{};
    for (unsigned j = 0; j < 3; ++j) {
      face[j] = order.empty() ? faces[i][j] : order[faces[i][j]];
    }
    std::rotate(face.begin(), std::min_element(face.begin(), face.end()), face.end());
    result.push_back(face);
  }
  std::sort(result.begin(), result.end());
  return result;
}

Sizes withBspc(const OffModel& model, const EncodeOptions& options) {
  PointSetView view(model.xyz.data(), model.points());
  view.setMesh(&model.cells);
  MemorySink sink;
  const EncodeReport report = encode(view, sink, options);
  const Bytes bytes = sink.take();
  Decoder decoder(std::make_shared<MemorySource>(bytes));
  const DecodedPoints decoded = decoder.decode();
  if (sortedFaces(decoded.mesh.faces, report.order) != sortedFaces(model.cells.faces, {})) {
    throw std::runtime_error("bspc: other faces came back");
  }
  return {bytes.size(), report.meshBytes, true, report.method == Method::Surface};
}

void measure(const std::string& name, bool positionsFirst) {
  const OffModel model = bench::inTriangles(bench::readOff(name));
  EncodeOptions options;
  options.grid = GridRequest::withBits(kBits);
  options.effort = kMostEffort;
  if (positionsFirst) options.method = Method::Predictive;
  options.layers = 1;
  options.wantOrder = true;
  const Sizes bspc = withBspc(model, options);
  const Sizes draco = withDraco(model);
  const auto perTriangle = [&](std::size_t bytes) {
    return 8.0 * static_cast<double>(bytes) / static_cast<double>(model.cells.faces.size());
  };
  std::printf("%-24s %8llu %9zu | %9zu %9zu %7.3f%c| %9zu %9zu %7.3f | %6.3f%s\n",
              bench::baseName(name).c_str(), static_cast<unsigned long long>(model.points()),
              model.cells.faces.size(), bspc.whole - bspc.faces, bspc.faces,
              perTriangle(bspc.faces), bspc.alongFaces ? '*' : ' ', draco.whole - draco.faces,
              draco.faces, perTriangle(draco.faces),
              static_cast<double>(bspc.whole) / static_cast<double>(draco.whole),
              draco.kept ? "" : " (Draco changed it)");
  std::fflush(stdout);
}

}  // namespace
}  // namespace bspc

int main(int argc, char** argv) {
  std::printf("%-24s %8s %9s | %9s %9s %7s | %9s %9s %7s | %6s\n", "mesh", "points", "triangles",
              "bspc rest", "faces", "bit/tri", "Draco", "faces", "bit/tri", "ratio");
  int failures = 0;
  const bool positionsFirst = argc > 1 && std::string(argv[1]) == "--positions-first";
  for (int i = positionsFirst ? 2 : 1; i < argc; ++i) {
    try {
      bspc::measure(argv[i], positionsFirst);
    } catch (const std::exception& error) {
      std::fprintf(stderr, "%s: %s\n", argv[i], error.what());
      ++failures;
    }
  }
  return failures == 0 ? 0 : 1;
}
