// SPDX-License-Identifier: MIT
// Numbers for keys in the order in which they are met: a table of open addressing, whose numbers depend
// on that order alone.
#pragma once

#include "tunica/core/types.hpp"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace tunica::meshing {

/// Any keys but the greatest one.
class NumberTable {
 public:
  /// The number of the key; that of a new one is how many there were.
  [[nodiscard]] Index of(std::uint64_t key) {
    if (2 * static_cast<std::size_t>(count_) >= slots_.size()) grow();
    Slot& s = slots_[place(key)];
    if (s.key == none) s = {key, count_++};
    return s.number;
  }
  /// How many keys have numbers.
  [[nodiscard]] Index count() const { return count_; }

 private:
  static constexpr std::uint64_t none = ~std::uint64_t{0};
  struct Slot {
    std::uint64_t key = none;
    Index number = 0;
  };

  /// Where the key is or may be put: the upper bits of its product with 2^64 over the golden ratio, and on
  /// from there.
  [[nodiscard]] std::size_t place(std::uint64_t key) const {
    auto i = static_cast<std::size_t>(key * 0x9E3779B97F4A7C15U >> shift_);
    while (slots_[i].key != none && slots_[i].key != key) i = (i + 1) & (slots_.size() - 1);
    return i;
  }

  void grow() {
    std::vector<Slot> old(slots_.empty() ? 1024 : 2 * slots_.size());
    old.swap(slots_);
    shift_ = 64;
    for (std::size_t n = slots_.size(); n > 1; n /= 2) --shift_;
    for (const Slot& s : old)
      if (s.key != none) slots_[place(s.key)] = s;
  }

  std::vector<Slot> slots_;
  unsigned shift_ = 64;
  Index count_ = 0;
};

}  // namespace tunica::meshing
