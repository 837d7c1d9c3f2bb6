#pragma once

#include <string>

#include "bspc/error.h"

namespace bspc::cli {

/// An error whose message names its file already.
class NamedError : public Error {
 public:
  using Error::Error;
};

/// Runs `work` on the file called `name`; errors of the library leave with that name in front.
template <class Work>
auto naming(const std::string& name, Work work) {
  try {
    return work();
  } catch (const NamedError&) {
    throw;
  } catch (const Error& error) {
    throw Error(error.code(), name + ": " + error.what());
  }
}

}  // namespace bspc::cli
