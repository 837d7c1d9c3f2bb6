#pragma once

#include "entropy/logistic_math.h"
#include "geometry/predictive/axis_residuals.h"
#include "geometry/predictive/axis_values.h"
#include "geometry/predictive/candidates_body.h"
#include "geometry/predictive/coordinates.h"
#include "geometry/predictive/density.h"
#include "geometry/predictive/features.h"
#include "geometry/predictive/flat_boxes.h"
#include "geometry/predictive/known_points.h"
#include "geometry/predictive/phase_lattice.h"
#include "geometry/predictive/surface_fit.h"

namespace bspc::geometry::predictive {
inline namespace BSPC_LANE_SET {

/// Fine classes of evidence.
constexpr unsigned kLogitClasses = 25;
inline unsigned logitClass(float evidence) {
  return entropy::classOf(evidence, 2, 12.5F, kLogitClasses);
}

/// Everything that predicts, over one neighbourhood. Each predictor is told what is known around
/// the box, is asked the question, and leaves its evidence (a logit for the upper half) and a class
/// of the situation as it sees it in its members. DecisionModel makes inputs and contexts of them.
struct Predictors {
  Predictors(const Features& chosen, unsigned bits, std::uint32_t count)
      : features(chosen), candidates(chosen), axisValues(bits, count) {}

  const Features features;
  Neighbourhood near;
  NearPoints points;

  // What is expected here, from what was found around.
  bool inCell = false;           ///< depth first: candidates and near points speak
  float cellSpacing = 1;         ///< of the cell at hand, from the counts around it
  float spacing = 1;             ///< between neighbouring points, in grid steps
  float surfaceError = 0.2F;     ///< of the quadric, in spacings
  float candidateError = 0.15F;  ///< of candidates, in spacings

  Surface surface;
  Candidates candidates;
  Coordinates coordinates;
  Density density;
  FlatBoxes flat;
  AxisResiduals residuals;
  AxisValues axisValues;
  PhaseHistograms phases;
  float planeEvidence = 0;
  float quadricEvidence = 0;
  float narrowQuadricEvidence = 0;
  float phaseEvidence = 0;
  bool phaseSpeaks = false;

  /// Before the first question about a cell that is divided breadth first.
  void startBreadthFirst(const Vector3& centre, float side) {
    inCell = false;
    spacing = 0.7F * side;
    surfaceError = 0.2F;
    candidateError = 0.15F;
    constexpr float kReach = 1.1F / 0.7F;
    surface.fit(near, centre, spacing, kReach, features.has(Features::kQuadric));
  }

  /// Before a cell that is coded depth first. The neighbourhood is gathered, `spacing` is a guess.
  void startCell(const KnownPoints& known, float side) {
    inCell = true;
    const float middle = 0.5F * side;
    points.gather(near, middle, middle, middle, features.nearPoints);
    near.forgetFarther();
    float sum = cellSpacing;
    float seen = 1;
    for (unsigned i = 0; i < points.count && i < 6; ++i) {
      const float nearest = known[points.known[i]].nearest;
      if (nearest >= 1e9F) continue;
      sum += nearest;
      seen += 1;
    }
    const float mean = sum / seen;
    candidates.startCell(points, side, mean < 1 ? 1 : mean);
    fitted_ = false;
  }

  /// When the box is not the half of the one asked about last, or a point was found.
  void startBox(const KnownPoints& known, const Question& q, bool onePoint) {
    expect(known, q, onePoint);
    candidates.startBox(q, spacing, candidateError, surface);
    coordinates.startBox();
    flat.start(features.flatShare, spacing, candidateError, surfaceError, surface.plane);
  }

  /// Instead, when the only point of the box is coded axis by axis.
  void startResiduals(const KnownPoints& known, const Question& q) {
    expect(known, q, true);
    candidates.startResiduals(q, spacing, candidateError);
    residuals.start(q, surface);
  }

  void ask(const Question& q) {
    askSurface(q);
    if (inCell) {
      candidates.ask(q);
      coordinates.ask(q, points, spacing, features.has(Features::kWideCoordinates),
                      features.has(Features::kNearest));
      flat.remember(q, surfaceEvidence(), candidates);
    }
    if (!inCell || features.has(Features::kDensity)) {
      density.ask(q, near, spacing, inCell ? kDensityEntries : Neighbourhood::kRoom);
    }
    if (features.has(Features::kAxisValues)) axisValues.ask(q);
    askPhase(q);
  }

  /// The same for a flat box.
  void askFlat(const Question& q) {
    coordinates.ask(q, points, spacing, false, false);
    if (features.has(Features::kAxisValues)) axisValues.ask(q);
    askPhase(q);
  }

  /// A half of the box lies outside the tile: what there is to ask is known.
  void skip(const Question& q, bool isFlat) {
    if (!inCell) return;
    if (!isFlat) candidates.ask(q);
    coordinates.forget(q.axis);
  }

  /// The box is halved: only one half of the last question's is left. Of what lies flat in it
  /// either half holds the same share.
  void take(unsigned axis, bool upper, bool isFlat) {
    if (!isFlat) candidates.take(axis, upper);
    coordinates.take(axis, upper);
  }

  /// Of what is left of the box along one axis.
  void askResidual(const Question& q) {
    if (features.has(Features::kAxisValues)) axisValues.ask(q);
    askPhase(q);
  }

  /// The better of the two fits.
  float surfaceEvidence() const { return surface.quadric.valid ? quadricEvidence : planeEvidence; }

  /// What the point at a place of this cell would have been predicted by; it joins what is known.
  /// `isLast`: of the cell, so that it need not help to predict others of it.
  void learn(KnownPoints& known, const GridPoint& position, const Vector3& place, bool isLast);

  /// What is remembered of points wherever they lie.
  void learnCoordinates(const GridPoint& position) {
    if (features.has(Features::kAxisValues)) axisValues.add(position);
    for (unsigned k = 0; k < 3; ++k) {
      if (phases[k].isActive()) phases[k].add(position[k]);
    }
  }

 private:
  /// What is to be expected around a box, from the points nearest to it.
  void expect(const KnownPoints& known, const Question& q, bool onePoint) {
    const Vector3 centre{q.centre(0), q.centre(1), q.centre(2)};
    float sum = cellSpacing;
    float seen = 1;
    float surfaceErrors = 0.1F;
    float candidateErrors = 0.3F;
    const unsigned found = points.visitSix(centre[0], centre[1], centre[2], [&](std::uint32_t i) {
      const KnownPoint& point = known[i];
      if (point.nearest < 1e9F) {
        sum += point.nearest;
        seen += 1;
      }
      surfaceErrors += point.surfaceError;
      candidateErrors += point.candidateError;
    });
    spacing = sum / seen;
    if (!(spacing >= 1)) spacing = 1;
    const float all = 1 + static_cast<float>(found);
    surfaceError = surfaceErrors / all + 0.3F / spacing;
    candidateError = candidateErrors / all;
    if (!fitted_ || features.refit == Features::Refit::Always ||
        (features.refit == Features::Refit::PerPoint && onePoint)) {
      surface.fit(near, centre, spacing, 1.1F, features.has(Features::kQuadric));
      fitted_ = true;
    }
  }

  void askSurface(const Question& q) {
    const bool wantPlane = !inCell || features.has(Features::kPlane) || !surface.quadric.valid;
    const auto [wide, narrow] = surface.quadric.spreadsIn(q, surfaceError, 0.4F * surfaceError);
    if (!wantPlane && !features.has(Features::kNarrowQuadric)) {
      quadricEvidence = halvesLogit(wide);
      narrowQuadricEvidence = planeEvidence = 0;
      return;
    }
    HalvesLogits logits;
    logits.add(wide);
    logits.add(narrow);
    if (wantPlane) logits.add(surface.plane.spreadIn(q));
    const std::array<float, entropy::kLanes> values = logits.values();
    quadricEvidence = values[0];
    narrowQuadricEvidence = values[1];
    planeEvidence = values[2];
  }

  void askPhase(const Question& q) {
    const PhaseHistogram& histogram = phases[q.axis];
    phaseSpeaks = q.open <= histogram.maxLevel();
    phaseEvidence = 0;
    if (!phaseSpeaks) return;
    const PhaseHistogram::Sides sides = histogram.sides(q.value, q.open);
    phaseEvidence = entropy::naturalLog((static_cast<float>(sides.upper) + 0.02F) /
                                        (static_cast<float>(sides.lower) + 0.02F));
  }

  static constexpr unsigned kDensityEntries = 24;
  bool fitted_ = false;
};

inline void Predictors::learn(KnownPoints& known, const GridPoint& position, const Vector3& place,
                              bool isLast) {
  const auto [px, py, pz] = place;
  KnownPoint point;
  point.position = position;
  float nearest = KnownPoint::kFar;
  for (unsigned i = 0; i < points.count; ++i) {
    const float dx = points.x[i] - px;
    const float dy = points.y[i] - py;
    const float dz = points.z[i] - pz;
    const float distance = std::sqrt(dx * dx + dy * dy + dz * dz);
    nearest = distance < nearest ? distance : nearest;
    KnownPoint& other = known[points.known[i]];
    other.nearest = distance < other.nearest ? distance : other.nearest;
  }
  point.nearest = nearest;
  const float unit = 1 / spacing;
  point.candidateError =
      std::sqrt(candidates.nearestSquare(px, py, pz, 0.25F * spacing * spacing)) * unit;
  if (surface.quadric.valid) {
    const Quadric::Value value = surface.quadric.at(px, py, pz);
    point.surfaceError =
        entropy::magnitude(value.height) / std::sqrt(dot(value.gradient, value.gradient) + 1e-6F);
  } else if (surface.plane.valid) {
    const Plane& plane = surface.plane;
    point.surfaceError = entropy::magnitude(plane.normal[0] * (px - plane.through[0]) +
                                            plane.normal[1] * (py - plane.through[1]) +
                                            plane.normal[2] * (pz - plane.through[2])) *
                         unit;
  } else {
    point.surfaceError = 0.3F;
  }
  const auto index = static_cast<std::uint32_t>(known.size());
  known.push_back(point);
  learnCoordinates(position);
  if (isLast) return;
  near.addDecoded(px, py, pz, index);
  if (points.full()) return;
  points.add(px, py, pz, index);
  candidates.addPoint(points);
}

}  // namespace BSPC_LANE_SET
}  // namespace bspc::geometry::predictive
