#pragma once

#include <string>

#include "formats/model_io.h"

namespace bspc::cli {

/// The format that `name` spells ("ply", …), or that the ending of `path` says if `name` is empty.
/// Both throw UsageError if neither tells, the second also if the format is not written.
formats::Format chooseInputFormat(const std::string& name, const std::string& path);
formats::Format chooseOutputFormat(const std::string& name, const std::string& path);

/// Reads a model file. What a .bspc file cannot hold yet is refused by Error(Unsupported), unless
/// `positionsOnly` is the user's word that it may be left out. Messages name the file.
formats::Model readModelFile(const std::string& path, const std::string& formatName,
                             bool positionsOnly, const ProgressCallback& progress);

}  // namespace bspc::cli
