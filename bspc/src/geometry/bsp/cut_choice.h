#pragma once

#include "bspc/span.h"
#include "geometry/bsp/cut_parameters.h"

namespace bspc::geometry {

// What the encoder alone decides about a cut plane; the decoder is told.

/// The principal direction of the points (eigenvector of the greatest eigenvalue of their
/// covariance), described in the frame and clamped as the paper has it.
WantedDirection wantedDirection(Span<const GridPoint> points, const LocalFrame& frame);

/// Where on the diagonal, 0 … 1, the plane across `normal` through the points' median meets it,
/// clamped to 0.2 … 0.8.
double wantedAlpha(Span<const GridPoint> points, const LocalFrame& frame,
                   const IntegerVector& normal);

}  // namespace bspc::geometry
