#include <algorithm>
#include <iostream>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>

#include "bspc/decoder.h"
#include "cli/commands.h"
#include "cli/input_file.h"
#include "cli/mesh_comparison.h"
#include "cli/naming.h"
#include "cli/shared_options.h"
#include "cli/text.h"
#include "cli/usage_error.h"
#include "formats/wording.h"

namespace bspc::cli {

namespace {

using Json = nlohmann::ordered_json;

struct InfoArguments {
  std::string input;
  bool json = false;
  bool partial = false;
  bool query = false;
  QueryArguments part;
};

double bitsPerPoint(std::uint64_t bytes, std::uint64_t points) {
  return points > 0 ? 8.0 * static_cast<double>(bytes) / static_cast<double>(points) : 0;
}

/// Tiles of each method, in words of the method.
std::map<std::string, std::uint64_t> methodsOf(const FileInfo& info) {
  std::map<std::string, std::uint64_t> methods;
  for (const TileInfo& tile : info.tiles) ++methods[methodName(tile.method)];
  return methods;
}

Json boundsJson(const FileInfo& info) {
  Json bounds = Json::array();
  for (int k = 0; k < 3; ++k) {
    const auto axis = static_cast<std::size_t>(k);
    bounds.push_back({restoredCoordinate(info.grid, k, info.lower[axis]),
                      restoredCoordinate(info.grid, k, info.upper[axis])});
  }
  return bounds;
}

const char* formName(Grid::Form form) {
  switch (form) {
    case Grid::Form::Rational:
      return "rational";
    case Grid::Form::Affine:
      return "affine";
    case Grid::Form::FloatBits:
      break;
  }
  return "floatBits";
}

const char* semanticName(Semantic semantic) {
  switch (semantic) {
    case Semantic::Scalars:
      return "scalars";
    case Semantic::Normals:
      return "normals";
    case Semantic::Colours:
      return "colours";
    case Semantic::TextureCoordinates:
      return "textureCoordinates";
    case Semantic::Ids:
      return "ids";
    case Semantic::None:
      break;
  }
  return "";
}

Json descriptionJson(const ArrayDescription& array) {
  Json json{
      {"name", array.name}, {"type", scalarName(array.type)}, {"components", array.components}};
  if (!array.componentNames.empty()) json["componentNames"] = array.componentNames;
  if (!array.unit.empty()) json["unit"] = array.unit;
  if (array.semantic != Semantic::None) json["semantic"] = semanticName(array.semantic);
  if (array.tolerance > 0) json["tolerance"] = array.tolerance;
  return json;
}

Json arraysJson(const FileInfo& info) {
  Json json = Json::array();
  for (const ArrayInfo& array : info.arrays) {
    Json entry = descriptionJson(array);
    entry["bytes"] = array.bytes;
    entry["bitsPerValue"] = bitsPerPoint(array.bytes, info.points) / array.components;
    entry["firstLevel"] = array.firstLevel;
    json.push_back(std::move(entry));
  }
  return json;
}

Json meshJson(const MeshInfo& mesh) {
  Json json{{"vertexCells", mesh.vertices},
            {"lines", mesh.lines},
            {"faces", mesh.faces},
            {"bytes", mesh.bytes},
            {"missing", mesh.missing}};
  json["arrays"] = Json::array();
  for (const ArrayInfo& array : mesh.arrays) json["arrays"].push_back(descriptionJson(array));
  return json;
}

Json metadataJson(const Metadata& metadata) {
  Json json = Json::object();
  if (!metadata.crs.empty()) json["crs"] = metadata.crs;
  if (!metadata.lengthUnit.empty()) json["lengthUnit"] = metadata.lengthUnit;
  json["entries"] = Json::object();
  for (const auto& [key, text] : metadata.entries) json["entries"][key] = text;
  json["fieldData"] = Json::array();
  for (const ArrayValues& array : metadata.fieldData) {
    Json entry = descriptionJson(array);
    entry["tuples"] = array.tuples();
    json["fieldData"].push_back(std::move(entry));
  }
  return json;
}

Json toJson(const FileInfo& info) {
  Json json;
  json["version"] = std::to_string(info.versionMajor) + "." + std::to_string(info.versionMinor);
  json["layout"] = info.streaming ? "streaming" : "progressive";
  json["points"] = info.points;
  json["fileBytes"] = info.fileBytes;
  json["geometryBytes"] = info.geometryBytes;
  json["bitsPerPoint"] = bitsPerPoint(info.fileBytes, info.points);
  json["scalarType"] = scalarName(info.grid.scalarType);
  json["gridForm"] = formName(info.grid.form);
  json["step"] = {info.grid.step(0), info.grid.step(1), info.grid.step(2)};
  if (info.points > 0) json["bounds"] = boundsJson(info);
  json["methods"] = methodsOf(info);
  json["tiles"] = info.tiles.size();
  json["wholeLayers"] = info.wholeLayers;
  json["layers"] = Json::array();
  for (const LayerInfo& layer : info.layers) {
    json["layers"].push_back(
        {{"points", layer.points}, {"spreadSteps", layer.spread}, {"bytes", layer.bytes}});
  }
  json["keepsOrder"] = info.keepsOrder;
  json["orderBytes"] = info.orderBytes;
  json["arrays"] = arraysJson(info);
  if (!info.mesh.empty()) json["mesh"] = meshJson(info.mesh);
  json["metadata"] = metadataJson(info.metadata);
  return json;
}

std::string padded(const std::string& text, std::size_t width) {
  return text.size() < width ? std::string(width - text.size(), ' ') + text : text;
}

/// "float32", "3 x uint8".
std::string typeText(const ArrayDescription& array) {
  const std::string type = scalarName(array.type);
  return array.components == 1 ? type : std::to_string(array.components) + " x " + type;
}

double bitsPerValue(const ArrayInfo& array, std::uint64_t points) {
  return bitsPerPoint(array.bytes, points) / array.components;
}

/// What is special about an array, in words.
std::string notesOf(const ArrayInfo& array) {
  std::string notes;
  const auto note = [&](const std::string& text) { notes += (notes.empty() ? "" : "; ") + text; };
  std::string components;
  for (const std::string& component : array.componentNames) {
    components += (components.empty() ? "" : ", ") + component;
  }
  if (!components.empty()) note(oneLine(components, 60));
  if (!array.unit.empty()) note("in " + oneLine(array.unit, 30));
  if (array.tolerance > 0) note("within " + rounded(array.tolerance));
  if (array.firstLevel > 0) note("from level " + std::to_string(array.firstLevel) + " on");
  return notes;
}

void printArrays(const FileInfo& info) {
  if (info.arrays.empty()) return;
  std::size_t widest = 5;
  for (const ArrayInfo& array : info.arrays) {
    widest = std::max(widest, oneLine(array.name, 40).size());
  }
  std::cout << "array" << std::string(widest - 5, ' ')
            << "          type           bytes  bits a value\n";
  for (const ArrayInfo& array : info.arrays) {
    const std::string name = oneLine(array.name, 40);
    const std::string notes = notesOf(array);
    std::cout << name << std::string(widest - name.size(), ' ') << padded(typeText(array), 14)
              << padded(withCommas(array.bytes), 16)
              << padded(fixed(bitsPerValue(array, info.points), 3), 14)
              << (notes.empty() ? "" : "  " + notes) << '\n';
  }
}

void printMetadata(const Metadata& metadata) {
  constexpr std::size_t kLongest = 90;
  if (!metadata.crs.empty()) std::cout << "crs        " << oneLine(metadata.crs, kLongest) << '\n';
  if (!metadata.lengthUnit.empty()) {
    std::cout << "unit       " << oneLine(metadata.lengthUnit, kLongest) << '\n';
  }
  for (const auto& [key, text] : metadata.entries) {
    std::cout << "metadata   " << oneLine(key, 40) << " = " << oneLine(text, kLongest) << '\n';
  }
  for (const ArrayValues& array : metadata.fieldData) {
    std::cout << "metadata   " << oneLine(array.name, 40) << ": "
              << formats::counted(array.tuples(), "tuple", "tuples") << " of " << typeText(array)
              << '\n';
  }
}

void printText(const std::string& name, const FileInfo& info) {
  std::cout << name << ": bspc " << info.versionMajor << '.' << info.versionMinor << ", "
            << (info.streaming ? "streaming" : "progressive") << " layout\n"
            << "points     " << withCommas(info.points) << '\n'
            << "bytes      " << withCommas(info.fileBytes) << " ("
            << fixed(bitsPerPoint(info.fileBytes, info.points), 3) << " bits per point; "
            << withCommas(info.geometryBytes) << " geometry)\n"
            << "grid       " << gridText(info.grid) << '\n';
  if (info.points > 0) {
    std::cout << "bounds    ";
    for (int k = 0; k < 3; ++k) {
      const auto axis = static_cast<std::size_t>(k);
      std::cout << ' ' << "xyz"[k] << " ["
                << coordinateText(info.grid, restoredCoordinate(info.grid, k, info.lower[axis]))
                << ", "
                << coordinateText(info.grid, restoredCoordinate(info.grid, k, info.upper[axis]))
                << ']';
    }
    std::cout << '\n';
  }
  std::cout << "tiles      " << withCommas(info.tiles.size());
  for (const auto& [method, tiles] : methodsOf(info)) {
    std::cout << (info.tiles.size() == tiles ? ", " : ", " + withCommas(tiles) + " of ") << method;
  }
  std::cout << "\nlevel          points       within  bytes of the layer\n";
  for (std::size_t l = 0; l < info.layers.size(); ++l) {
    const LayerInfo& layer = info.layers[l];
    const std::string points = withCommas(layer.points);
    // Steps between the bits of floats differ from place to place.
    const bool varies = layer.spread > 0 && info.grid.form == Grid::Form::FloatBits;
    const std::string within = varies ? "varies" : rounded(layer.spread * info.grid.step(0));
    const std::string level = std::to_string(l);
    std::cout << padded(level, 5) << padded(points, 16) << padded(within, 13)
              << padded(withCommas(layer.bytes), 20)
              << (l < info.wholeLayers ? "" : "  (not in this file)") << '\n';
  }
  printArrays(info);
  if (!info.mesh.empty()) {
    std::cout << "mesh       " << cellsText(info.mesh.vertices, info.mesh.lines, info.mesh.faces)
              << " ("
              << (info.mesh.missing ? "not in this file)"
                                    : withCommas(info.mesh.bytes) + " bytes, with their arrays)")
              << '\n';
    for (const ArrayInfo& array : info.mesh.arrays) {
      std::cout << "           " << oneLine(array.name, 40) << ", " << typeText(array)
                << " a cell\n";
    }
  }
  if (info.keepsOrder) {
    std::cout << "order      as in the input (" << withCommas(info.orderBytes) << " bytes)\n";
  }
  printMetadata(info.metadata);
}

/// Texts of a file that are no UTF-8 must not stop it from being shown.
std::string text(const Json& json) {
  return json.dump(2, ' ', false, Json::error_handler_t::replace);
}

/// What decoding a part would read.
void printQuery(const InfoArguments& args, const std::string& name, const Decoder& decoder) {
  const FileInfo& info = decoder.info();
  const QueryCost cost = decoder.cost(decodeOptions(args.part));
  if (args.json) {
    const Json json{{"tiles", cost.tiles},     {"tilesOfFile", info.tiles.size()},
                    {"level", cost.level},     {"pointsAtMost", cost.points},
                    {"bytesRead", cost.bytes}, {"fileBytes", info.fileBytes}};
    std::cout << json.dump(2) << '\n';
    return;
  }
  const double share = static_cast<double>(cost.bytes) / static_cast<double>(info.fileBytes);
  std::cout << name << ": reads " << withCommas(cost.bytes) << " of " << withCommas(info.fileBytes)
            << " bytes (" << fixed(100 * share, 2) << " %), " << withCommas(cost.tiles) << " of "
            << withCommas(info.tiles.size()) << " tiles up to level " << cost.level << ", at most "
            << withCommas(cost.points) << " points\n";
}

void runInfo(const InfoArguments& args) {
  if (args.part.any() && !args.query) {
    throw UsageError("--level, --max-points and --box go with --query");
  }
  InputFile input(args.input);
  OpenOptions options;
  options.allowPartial = args.partial;
  const Decoder decoder = naming(input.name(), [&] { return Decoder(input.source(), options); });
  if (args.query) {
    naming(input.name(), [&] { printQuery(args, input.name(), decoder); });
  } else if (args.json) {
    std::cout << text(toJson(decoder.info())) << '\n';
  } else {
    printText(input.name(), decoder.info());
  }
}

}  // namespace

void addInfoCommand(CLI::App& app) {
  auto args = std::make_shared<InfoArguments>();
  CLI::App* command =
      app.add_subcommand("info", "Show what a .bspc file holds, without decoding it");
  command->add_option("file", args->input, "The .bspc file; - reads a pipe")->required();
  command->add_flag("--json", args->json, "Print JSON");
  command->add_flag("--partial", args->partial, "Accept a file that was cut short");
  command->add_flag("--query", args->query,
                    "Say what decoding a part would read (all without the options below)");
  addQueryOptions(*command, args->part);
  command->callback([args] { runInfo(*args); });
  command->footer(
      "Examples:\n"
      "  bspc info scan.bspc\n"
      "  bspc info scan.bspc --json | jq .points\n"
      "  bspc info scan.bspc --query --box 0,0,0,10,10,2.5");
}

}  // namespace bspc::cli
