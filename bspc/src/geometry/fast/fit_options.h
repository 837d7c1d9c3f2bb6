#pragma once

namespace bspc::geometry::fast {

/// Which surfaces the encoder tries; the decoder does not depend on it.
struct FitOptions {
  bool quadrics = true;
};

}  // namespace bspc::geometry::fast
