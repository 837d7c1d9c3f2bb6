#pragma once

#include <string>

#include "bspc/error.h"

namespace bspc::cli {

/// Runs `work` on the file called `name`; errors of the library leave with that name in front.
template <class Work>
auto naming(const std::string& name, Work work) {
  try {
    return work();
  } catch (const Error& error) {
    throw Error(error.code(), name + ": " + error.what());
  }
}

}  // namespace bspc::cli
