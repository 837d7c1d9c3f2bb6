#pragma once

#include <cstdint>
#include <vector>

namespace bspc::connectivity {

/// The open gates at each vertex: directed edges u → v along which a face can still be added. Lists
/// have the gate that was opened last in front. A gate goes by the corner across, the one that
/// v → u leaves from, so that any is closed in the same time however many a vertex has.
class OpenGates {
 public:
  explicit OpenGates(std::size_t vertices)
      : leaving_(vertices, kNone), entering_(vertices, kNone), count_(vertices, 0) {}

  void addVertex() {
    leaving_.push_back(kNone);
    entering_.push_back(kNone);
    count_.push_back(0);
  }

  void open(std::uint32_t from, std::uint32_t to, std::uint32_t corner) {
    std::uint32_t at = free_;
    if (at == kNone) {
      at = static_cast<std::uint32_t>(gates_.size());
      gates_.emplace_back();
    } else {
      free_ = gates_[at].leaving.next;
    }
    if (corner >= gateOf_.size()) gateOf_.resize(std::size_t{corner} + 1, kNone);
    gateOf_[corner] = at;
    gates_[at].from = from;
    gates_[at].to = to;
    push(leaving_[from], at, &Gate::leaving);
    push(entering_[to], at, &Gate::entering);
    ++count_[from];
    ++count_[to];
  }

  /// The gate across a corner, which must be open.
  void close(std::uint32_t corner) {
    const std::uint32_t at = gateOf_[corner];
    const Gate gate = gates_[at];
    remove(leaving_[gate.from], at, &Gate::leaving);
    remove(entering_[gate.to], at, &Gate::entering);
    --count_[gate.from];
    --count_[gate.to];
    gates_[at].leaving.next = free_;
    free_ = at;
  }

  /// Open gates that begin or end at the vertex.
  std::uint32_t count(std::uint32_t vertex) const { return count_[vertex]; }

  /// Calls visit(other end) for up to `most` gates that begin, or end, at the vertex.
  template <class Visit>
  void leaving(std::uint32_t vertex, unsigned most, Visit visit) const {
    for (std::uint32_t at = leaving_[vertex]; at != kNone && most > 0; --most) {
      visit(gates_[at].to);
      at = gates_[at].leaving.next;
    }
  }
  template <class Visit>
  void entering(std::uint32_t vertex, unsigned most, Visit visit) const {
    for (std::uint32_t at = entering_[vertex]; at != kNone && most > 0; --most) {
      visit(gates_[at].from);
      at = gates_[at].entering.next;
    }
  }

  std::size_t bytes() const {
    return gates_.capacity() * sizeof(Gate) + gateOf_.capacity() * sizeof(std::uint32_t);
  }

 private:
  static constexpr std::uint32_t kNone = 0xFFFFFFFF;
  /// A place in a list.
  struct Links {
    std::uint32_t before = kNone;
    std::uint32_t next = kNone;
  };
  struct Gate {
    std::uint32_t from = 0;
    std::uint32_t to = 0;
    Links leaving;   ///< among those that begin where it does; next is used for free gates too
    Links entering;  ///< among those that end where it does
  };

  void push(std::uint32_t& head, std::uint32_t at, Links Gate::*list) {
    gates_[at].*list = {kNone, head};
    if (head != kNone) (gates_[head].*list).before = at;
    head = at;
  }

  void remove(std::uint32_t& head, std::uint32_t at, Links Gate::*list) {
    const Links links = gates_[at].*list;
    (links.before != kNone ? (gates_[links.before].*list).next : head) = links.next;
    if (links.next != kNone) (gates_[links.next].*list).before = links.before;
  }

  std::vector<std::uint32_t> leaving_;
  std::vector<std::uint32_t> entering_;
  std::vector<std::uint32_t> count_;
  std::vector<Gate> gates_;
  std::vector<std::uint32_t> gateOf_;  ///< across each corner; stale once that is closed
  std::uint32_t free_ = kNone;
};

}  // namespace bspc::connectivity
