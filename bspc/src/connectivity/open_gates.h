#pragma once

#include <cstdint>
#include <vector>

namespace bspc::connectivity {

/// The open gates at each vertex: directed edges u → v along which a face can still be added. Lists
/// have the gate that was opened last in front.
class OpenGates {
 public:
  explicit OpenGates(std::size_t vertices)
      : leaving_(vertices, kNone), entering_(vertices, kNone), count_(vertices, 0) {}

  void addVertex() {
    leaving_.push_back(kNone);
    entering_.push_back(kNone);
    count_.push_back(0);
  }

  void open(std::uint32_t from, std::uint32_t to) {
    push(leaving_[from], to);
    push(entering_[to], from);
    ++count_[from];
    ++count_[to];
  }

  /// The gate must be open.
  void close(std::uint32_t from, std::uint32_t to) {
    remove(leaving_[from], to);
    remove(entering_[to], from);
    --count_[from];
    --count_[to];
  }

  /// Open gates that begin or end at the vertex.
  std::uint32_t count(std::uint32_t vertex) const { return count_[vertex]; }

  /// Calls visit(other end) for up to `most` gates that begin, or end, at the vertex.
  template <class Visit>
  void leaving(std::uint32_t vertex, unsigned most, Visit visit) const {
    walk(leaving_[vertex], most, visit);
  }
  template <class Visit>
  void entering(std::uint32_t vertex, unsigned most, Visit visit) const {
    walk(entering_[vertex], most, visit);
  }

 private:
  static constexpr std::uint32_t kNone = 0xFFFFFFFF;
  struct Link {
    std::uint32_t vertex = 0;
    std::uint32_t next = kNone;
  };

  void push(std::uint32_t& head, std::uint32_t vertex) {
    std::uint32_t at = free_;
    if (at == kNone) {
      at = static_cast<std::uint32_t>(links_.size());
      links_.emplace_back();
    } else {
      free_ = links_[at].next;
    }
    links_[at] = {vertex, head};
    head = at;
  }

  void remove(std::uint32_t& head, std::uint32_t vertex) {
    std::uint32_t* at = &head;
    while (links_[*at].vertex != vertex) at = &links_[*at].next;
    const std::uint32_t gone = *at;
    *at = links_[gone].next;
    links_[gone].next = free_;
    free_ = gone;
  }

  template <class Visit>
  void walk(std::uint32_t at, unsigned most, Visit visit) const {
    for (; at != kNone && most > 0; at = links_[at].next, --most) visit(links_[at].vertex);
  }

  std::vector<std::uint32_t> leaving_;
  std::vector<std::uint32_t> entering_;
  std::vector<std::uint32_t> count_;
  std::vector<Link> links_;
  std::uint32_t free_ = kNone;
};

}  // namespace bspc::connectivity
