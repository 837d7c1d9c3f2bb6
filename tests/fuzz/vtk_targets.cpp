#include "target.h"

namespace bspc::fuzz {

std::vector<Target> targets() { return {vtkReaderTarget()}; }

}  // namespace bspc::fuzz
