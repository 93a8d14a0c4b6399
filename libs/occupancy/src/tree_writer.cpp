// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "tree_writer.hpp"

#include <algorithm>
#include <cstring>
#include <limits>

#include "loopmark/storage/files.hpp"
#include "tile.hpp"

namespace loopmark::occupancy::internal {
namespace {

constexpr std::size_t kRecord = 5;

enum State : unsigned { kUnknown = 0, kFree = 1, kOccupied = 2, kInner = 3 };  // bit 0 first, as OctoMap stores them

/// Turns a full subtree into a binary one, records in preorder.
class BinaryConverter {
 public:
  explicit BinaryConverter(const std::string& full) : full_(full) {}

  Subtree run() {
    Subtree subtree;
    if (!full_.empty()) {
      const State state = node(subtree);
      subtree.leaf = state != kInner;
      subtree.value = state == kFree ? 0.0F : 1.0F;
    }
    return subtree;
  }

 private:
  State node(Subtree& out) {
    float value = 0.0F;
    std::memcpy(&value, full_.data() + at_, sizeof value);
    const auto mask = static_cast<unsigned char>(full_[at_ + sizeof value]);
    at_ += kRecord;
    ++out.nodes;
    if (mask == 0) {
      return value >= 0.0F ? kOccupied : kFree;
    }
    const std::size_t start = out.bytes.size();
    const std::size_t nodes_before = out.nodes;
    out.bytes.append(2, '\0');
    unsigned bits = 0;
    for (unsigned child = 0; child < 8; ++child) {
      if ((mask >> child & 1U) != 0) {
        bits |= static_cast<unsigned>(node(out)) << (2 * child);
      }
    }
    if (bits == 0x5555U || bits == 0xaaaaU) {  // eight leaves of one state: one leaf
      out.bytes.resize(start);
      out.nodes = nodes_before;
      return bits == 0x5555U ? kFree : kOccupied;
    }
    out.bytes[start] = static_cast<char>(bits & 255U);
    out.bytes[start + 1] = static_cast<char>(bits >> 8U);
    return kInner;
  }

  const std::string& full_;
  std::size_t at_ = 0;
};

}  // namespace

Subtree full_subtree(const std::string& tile_bytes) {
  Subtree subtree;
  subtree.bytes = tile_bytes;
  subtree.nodes = tile_bytes.size() / kRecord;
  if (!tile_bytes.empty()) {
    std::memcpy(&subtree.value, tile_bytes.data(), sizeof subtree.value);
    subtree.leaf = tile_bytes[sizeof subtree.value] == 0;
  }
  return subtree;
}

Subtree binary_subtree(const std::string& tile_bytes) { return BinaryConverter(tile_bytes).run(); }

TreeWriter::TreeWriter(TreeFormat format, double resolution_m, const std::filesystem::path& scratch)
    : format_(format), resolution_m_(resolution_m), file_(scratch), nodes_(1) {}

void TreeWriter::add(std::uint32_t tile_number, const Subtree& subtree) {
  if (subtree.nodes == 0) {
    return;
  }
  std::int32_t at = 0;
  for (int level = kTreeDepth - kTileLevels - 1; level >= 0; --level) {
    const auto child = static_cast<std::size_t>(tile_number >> (3 * level) & 7U);
    std::int32_t next = nodes_[static_cast<std::size_t>(at)].children[child];
    if (next == kNone) {
      next = static_cast<std::int32_t>(nodes_.size());
      nodes_[static_cast<std::size_t>(at)].children[child] = next;
      nodes_.emplace_back();
    }
    at = next;
  }
  Node& node = nodes_[static_cast<std::size_t>(at)];
  node.is_tile = true;
  node.extent = file_.append(subtree.bytes);
  node.leaf = subtree.leaf;
  node.value = subtree.value;
  node.nodes = subtree.nodes;
}

/// Values and counts of the nodes above the tiles, pruned like those below.
void TreeWriter::summarize(std::int32_t at) {
  Node& node = nodes_[static_cast<std::size_t>(at)];
  if (node.is_tile) {
    return;
  }
  node.nodes = 1;
  node.value = -std::numeric_limits<float>::infinity();
  bool alike = true;
  for (const std::int32_t child_at : node.children) {
    if (child_at == kNone) {
      alike = false;
      continue;
    }
    summarize(child_at);
    const Node& child = nodes_[static_cast<std::size_t>(child_at)];
    const Node* first = node.children[0] == kNone ? nullptr : &nodes_[static_cast<std::size_t>(node.children[0])];
    alike = alike && child.leaf && first != nullptr && child.value == first->value;
    node.nodes += child.nodes;
    node.value = std::max(node.value, child.value);
  }
  if (alike) {
    node.children.fill(kNone);
    node.leaf = true;
    node.nodes = 1;
  }
}

unsigned TreeWriter::child_mask(const Node& node) const {
  unsigned mask = 0;
  for (unsigned child = 0; child < 8; ++child) {
    mask |= node.children[child] != kNone ? 1U << child : 0U;
  }
  return mask;
}

unsigned TreeWriter::binary_mask(const Node& node) const {
  unsigned bits = 0;
  for (unsigned child = 0; child < 8; ++child) {
    if (node.children[child] != kNone) {
      const Node& c = nodes_[static_cast<std::size_t>(node.children[child])];
      const unsigned state = !c.leaf ? kInner : (c.value > 0.5F ? kOccupied : kFree);
      bits |= state << (2 * child);
    }
  }
  return bits;
}

void TreeWriter::write_node(std::ostream& out, std::int32_t at) {
  const Node& node = nodes_[static_cast<std::size_t>(at)];
  if (node.is_tile) {
    const std::string bytes = file_.read(node.extent);
    out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    return;
  }
  if (format_ == TreeFormat::kFull) {
    out.write(reinterpret_cast<const char*>(&node.value), sizeof node.value);
    out.put(static_cast<char>(child_mask(node)));
  } else if (!node.leaf || at == 0) {
    const unsigned bits = binary_mask(node);
    out.put(static_cast<char>(bits & 255U));
    out.put(static_cast<char>(bits >> 8U));
  }
  for (const std::int32_t child : node.children) {
    if (child != kNone) {
      write_node(out, child);
    }
  }
}

std::size_t TreeWriter::write(const std::filesystem::path& path) {
  const bool empty = nodes_.size() == 1;
  if (!empty) {
    summarize(0);
  }
  storage::write_file_atomically(path, [&](std::ostream& out) {
    out << (format_ == TreeFormat::kFull ? "# Octomap OcTree file" : "# Octomap OcTree binary file")
        << "\n# (feel free to add / change comments, but leave the first line as it is!)\n#\nid OcTree\nsize "
        << nodes_[0].nodes << "\nres " << resolution_m_ << "\ndata\n";
    if (!empty) {
      write_node(out, 0);
    }
  });
  return nodes_[0].nodes;
}

}  // namespace loopmark::occupancy::internal
