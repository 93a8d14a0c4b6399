// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace loopmark::places::internal {

constexpr Eigen::Index kShort = 64;  ///< size of a projected descriptor

/// A fixed random projection from `size` numbers to 64 that keeps distances on average (Johnson-Lindenstrauss).
Eigen::MatrixXf projection(Eigen::Index size);

/// Short vectors sorted into the cells of k-means centres (an inverted file, Sivic and Zisserman 2003).
class InvertedFile {
 public:
  /// Learns centres from the columns of `vectors` and sorts them in; the same result for the same columns.
  void build(const Eigen::MatrixXf& vectors);
  void add(const Eigen::VectorXf& vector);
  std::size_t size() const { return size_; }

  /// Calls visit(place, squared_distance) for every vector of the cells nearest to the query; place: order of adding.
  template <class Visit>
  void visit_near(const Eigen::VectorXf& query, const Visit& visit) const {
    for (const std::uint32_t c : nearest_cells(query)) {
      const Cell& cell = cells_[c];
      for (std::size_t i = 0; i < cell.places.size(); ++i) {
        const Eigen::Map<const Eigen::VectorXf> member(cell.members.data() + static_cast<Eigen::Index>(i) * kShort,
                                                       kShort);
        visit(cell.places[i], (member - query).squaredNorm());
      }
    }
  }

 private:
  struct Cell {
    std::vector<std::uint32_t> places;
    std::vector<float> members;
  };

  std::vector<std::uint32_t> nearest_cells(const Eigen::VectorXf& query) const;
  std::uint32_t nearest_cell(const Eigen::VectorXf& vector) const;
  void learn_centres(const Eigen::MatrixXf& vectors, Eigen::Index count);

  Eigen::MatrixXf centres_;  ///< kShort x cells
  std::vector<Cell> cells_;
  std::size_t size_ = 0;
};

}  // namespace loopmark::places::internal
