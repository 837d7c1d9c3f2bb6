#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "bspc/span.h"

class vtkMultiProcessController;

namespace bspc::vtk {

/// What several processes do together. Every call must be made by all of them.
class ProcessGroup {
 public:
  /// The controller must outlive this.
  explicit ProcessGroup(vtkMultiProcessController& controller) : controller_(controller) {}

  std::size_t rank() const;
  std::size_t size() const;

  /// Runs a step of which each process does its own. If it fails anywhere, all throw the
  /// bspc::Error of the first that failed, so that nobody waits for somebody who gave up.
  void step(const std::function<void()>& own);

  /// The bytes of all processes, by rank.
  std::vector<Bytes> gatherEverywhere(const Bytes& own);

  std::uint64_t sum(std::uint64_t own);
  double greatest(double own);
  /// Whether it holds for all.
  bool all(bool own);

 private:
  vtkMultiProcessController& controller_;
};

}  // namespace bspc::vtk
