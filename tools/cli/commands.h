#pragma once

#include <CLI/CLI.hpp>

namespace bspc::cli {

// Each adds its subcommand to the command line, to be run when it is chosen.
void addEncodeCommand(CLI::App& app);
void addDecodeCommand(CLI::App& app);
void addInfoCommand(CLI::App& app);
void addVerifyCommand(CLI::App& app);
void addJoinCommand(CLI::App& app);
void addBenchCommand(CLI::App& app);

}  // namespace bspc::cli
