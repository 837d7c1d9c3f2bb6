#include <cmath>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>

#include "bspc/decoder.h"
#include "bspc/encoder.h"
#include "bspc/error.h"
#include "bspc/stream_encoder.h"
#include "cli/commands.h"
#include "cli/input_file.h"
#include "cli/interrupts.h"
#include "cli/model_files.h"
#include "cli/naming.h"
#include "cli/output_file.h"
#include "cli/progress_bar.h"
#include "cli/scratch_file.h"
#include "cli/text.h"
#include "cli/usage_error.h"
#include "formats/wording.h"

namespace bspc::cli {

namespace {

struct EncodeArguments {
  std::string input;
  std::string output;
  std::string from;
  std::string method;
  std::string grid = "auto";
  std::string layout;
  unsigned bits = 0;
  double precision = 0;
  bool exact = false;
  std::string effort = "auto";
  double seconds = 0;
