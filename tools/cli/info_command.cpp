#include <iostream>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>

#include "bspc/decoder.h"
#include "cli/commands.h"
#include "cli/input_file.h"
#include "cli/naming.h"
#include "cli/text.h"

namespace bspc::cli {

namespace {

using Json = nlohmann::ordered_json;

struct InfoArguments {
  std::string input;
  bool json = false;
  bool partial = false;
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

Json toJson(const FileInfo& info) {
  Json json;
  json["version"] = std::to_string(info.versionMajor) + "." + std::to_string(info.versionMinor);
  json["layout"] = info.streaming ? "streaming" : "progressive";
  json["points"] = info.points;
  json["fileBytes"] = info.fileBytes;
  json["geometryBytes"] = info.geometryBytes;
  json["bitsPerPoint"] = bitsPerPoint(info.fileBytes, info.points);
  json["scalarType"] = scalarName(info.grid.scalarType);
  json["gridForm"] = info.grid.form == Grid::Form::Rational ? "rational" : "affine";
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
  return json;
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
                << shortest(restoredCoordinate(info.grid, k, info.lower[axis])) << ", "
                << shortest(restoredCoordinate(info.grid, k, info.upper[axis])) << ']';
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
    const std::string within = layer.spread == 0 ? "0" : shortest(layer.spread * info.grid.step(0));
    const std::string level = std::to_string(l);
    const auto pad = [](const std::string& text, std::size_t width) {
      return text.size() < width ? std::string(width - text.size(), ' ') + text : text;
    };
    std::cout << pad(level, 5) << pad(points, 16) << pad(within, 13)
              << pad(withCommas(layer.bytes), 20)
              << (l < info.wholeLayers ? "" : "  (not in this file)") << '\n';
  }
}

void runInfo(const InfoArguments& args) {
  InputFile input(args.input);
  OpenOptions options;
  options.allowPartial = args.partial;
  const Decoder decoder = naming(input.name(), [&] { return Decoder(input.source(), options); });
  if (args.json) {
    std::cout << toJson(decoder.info()).dump(2) << '\n';
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
  command->callback([args] { runInfo(*args); });
  command->footer(
      "Examples:\n"
      "  bspc info scan.bspc\n"
      "  bspc info scan.bspc --json | jq .points");
}

}  // namespace bspc::cli
