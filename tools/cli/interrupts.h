#pragma once

#include <string>

namespace bspc::cli {

/// Makes the first interrupt (Ctrl-C, a closed terminal) stop the work under way through the
/// progress callbacks, so that nothing half-written stays behind. A second one ends the program at
/// once.
void catchInterrupts();
bool interrupted();

/// The file to remove if a second interrupt ends the program; "" for none.
void setUnfinishedFile(const std::string& path);

}  // namespace bspc::cli
