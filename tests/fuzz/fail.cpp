#include <cstdio>
#include <cstdlib>

#include "target.h"

namespace bspc::fuzz {

void fail(const std::string& what) {
  std::fprintf(stderr, "fuzz: %s\n", what.c_str());
  std::abort();
}

}  // namespace bspc::fuzz
