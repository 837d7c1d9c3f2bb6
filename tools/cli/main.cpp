#include <CLI/CLI.hpp>
#include <exception>
#include <iostream>
#include <new>

#include "bspc/error.h"
#include "cli/commands.h"
#include "cli/interrupts.h"
#include "cli/usage_error.h"

namespace {

int run(int argc, char** argv) {
  CLI::App app(
      "bspc: compressed point sets.\n"
      "Turns the points of 3D models into small .bspc files and back, exactly or to a precision\n"
      "that you choose.");
  app.name("bspc");
  app.set_version_flag("--version", "bspc " BSPC_VERSION);
  app.require_subcommand(1);
  app.footer(
      "Examples:\n"
      "  bspc encode scan.ply scan.bspc\n"
      "  bspc verify scan.bspc --against scan.ply\n"
      "  bspc decode scan.bspc back.ply\n"
      "  bspc info scan.bspc\n"
      "  bspc bench scan.ply\n"
      "`bspc COMMAND --help` explains a command.\n\n"
      "Exit codes: 0 done, 1 failed (the reason is on standard error), 2 wrong usage.");
  bspc::cli::addEncodeCommand(app);
  bspc::cli::addDecodeCommand(app);
  bspc::cli::addInfoCommand(app);
  bspc::cli::addVerifyCommand(app);
  bspc::cli::addJoinCommand(app);
  bspc::cli::addBenchCommand(app);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? bspc::cli::kSuccess : bspc::cli::kUsage;
  }
  std::cout.flush();
  if (!std::cout) {
    throw bspc::Error(bspc::ErrorCode::Io, "standard output: could not be written");
  }
  return bspc::cli::kSuccess;
}

}  // namespace

int main(int argc, char** argv) {
  bspc::cli::catchInterrupts();
  // Or errors of reading standard input look like its end.
  std::ios::sync_with_stdio(false);
  try {
    return run(argc, argv);
  } catch (const bspc::cli::UsageError& error) {
    std::cerr << "bspc: " << error.what() << '\n';
    return bspc::cli::kUsage;
  } catch (const bspc::Error& error) {
    std::cerr << "bspc: " << error.what() << '\n';
  } catch (const std::bad_alloc&) {
    std::cerr << "bspc: not enough memory\n";
  } catch (const std::exception& error) {
    std::cerr << "bspc: " << error.what() << '\n';
  }
  return bspc::cli::kFailure;
}
