#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "bspc/encoder.h"
#include "bspc/io.h"
#include "bspc/join.h"
#include "codec/codec_support.h"
#include "support/array_sets.h"
#include "support/meshes.h"
#include "support/point_sets.h"

namespace bspc::test {

/// What is encoded into a small file: one of each part that a file can have, among them.
struct SmallFile {
  std::string name;
  std::vector<std::int32_t> xyz;
  std::vector<ArrayValues> arrays;
  MeshCells cells;
  EncodeOptions options;

  void encodeTo(ByteSink& sink) const {
    PointSetView view(xyz.data(), xyz.size() / 3);
    for (const ArrayValues& array : arrays) view.addArray(array.view());
    if (!cells.empty()) view.setMesh(&cells);
    encode(view, sink, options);
  }
  Bytes bytes() const {
    MemorySink sink;
    encodeTo(sink);
    return sink.take();
  }
};

inline std::vector<SmallFile> smallFiles() {
  std::vector<SmallFile> files;
  for (const Method method : availableMethods()) {
    SmallFile file;
    file.name = methodName(method);
    file.xyz = asIntegers(scannedSphere(7, 60, 500));
    file.options.method = method;
    file.options.layers = 2;
    file.options.threads = 1;
    files.push_back(file);
  }
  for (const Layout layout : {Layout::Progressive, Layout::Streaming}) {
    SmallFile file;
    file.name = layout == Layout::Streaming ? "tiles, streaming" : "tiles";
    file.xyz = asIntegers(scannedSphere(8, 90, 500));
    file.options.method = Method::Fast;
    file.options.tilePoints = 20;
    file.options.layout = layout;
    file.options.threads = 3;
    files.push_back(file);
  }
  SmallFile file;
  file.name = "arrays";
  file.xyz = asIntegers(scannedSphere(9, 40, 500));
  for (const ScalarType type : {ScalarType::Float32, ScalarType::Bit, ScalarType::String}) {
    file.arrays.push_back(randomArray(scalarName(type), type, 2, 40, 3));
  }
  file.options.method = Method::Kd;
  file.options.keepOrder = true;
  file.options.metadata.crs = "EPSG:25832";
  file.options.metadata.fieldData = file.arrays;
  file.options.threads = 1;
  files.push_back(file);
  for (const Method method : {Method::Kd, Method::Surface}) {
    const Mesh mesh = torus(8, 6, true);
    SmallFile net;
    net.name = std::string("mesh, ") + methodName(method);
    net.xyz = asIntegers(mesh.points);
    net.cells = mesh.cells;
    net.cells.lines.add(mesh.cells.faces[0]);
    net.cells.vertices.add(mesh.cells.faces[1]);
    net.options.method = method;
    net.options.threads = 1;
    files.push_back(net);
  }
  return files;
}

}  // namespace bspc::test
