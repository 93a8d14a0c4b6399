// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// Segments of something that outgrows memory: those in use in memory, the others on the disk.
#pragma once

#include <algorithm>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "loopmark/storage/scratch_file.hpp"

namespace loopmark::storage {

/// Items by key. An item has weight(), to_bytes() and a static from_bytes(); a default-made one is empty.
template <class Key, class Item>
class SpillStore {
 public:
  /// `max_weight`: sum of weight() kept in memory between rounds.
  SpillStore(const std::filesystem::path& scratch, std::size_t max_weight) : file_(scratch), max_weight_(max_weight) {}

  /// The item of a key, read back or made when it is not in memory. Valid until trim().
  Item& at(const Key& key) {
    Entry& entry = entries_[key];
    if (!entry.item) {
      entry.item = std::make_unique<Item>(entry.stored ? Item::from_bytes(file_.read(*entry.stored)) : Item());
    }
    entry.used = round_;
    return *entry.item;
  }

  /// Ends a round: moves the items that were not used for longest to the disk until the rest fits.
  void trim() {
    ++round_;
    std::size_t weight = 0;
    std::vector<std::pair<std::uint64_t, Entry*>> held;
    for (auto& [key, entry] : entries_) {
      if (entry.item) {
        weight += entry.item->weight();
        held.emplace_back(entry.used, &entry);
      }
    }
    if (weight <= max_weight_) {
      return;
    }
    std::stable_sort(held.begin(), held.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    // Down to three quarters, so that not every round has to.
    for (auto& [used, entry] : held) {
      if (weight <= max_weight_ * 3 / 4) {
        break;
      }
      weight -= entry->item->weight();
      entry->stored = file_.append(entry->item->to_bytes());
      entry->item.reset();
      ++spilled_;
    }
  }

  /// Bytes (Item::to_bytes) of each item in the order of the keys: visit(key, bytes).
  template <class Visit>
  void for_each(const Visit& visit) {
    for (auto& [key, entry] : entries_) {
      visit(key, entry.item ? entry.item->to_bytes() : file_.read(*entry.stored));
    }
  }

  std::size_t size() const { return entries_.size(); }
  std::size_t spilled() const { return spilled_; }  ///< times an item was moved to the disk

 private:
  struct Entry {
    std::unique_ptr<Item> item;
    std::optional<Extent> stored;
    std::uint64_t used = 0;  ///< round that used it last
  };

  std::map<Key, Entry> entries_;
  ScratchFile file_;
  std::size_t max_weight_;
  std::uint64_t round_ = 0;
  std::size_t spilled_ = 0;
};

}  // namespace loopmark::storage
