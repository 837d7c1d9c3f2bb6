#pragma once

/// Code can be compiled for more than one instruction set; each time it lives in an inline
/// namespace of its own, so that linkers keep the versions apart. Sources that are compiled for
/// another set than the rest of the library define its name before all.
#if !defined(BSPC_LANE_SET)
#define BSPC_LANE_SET portable
#endif
