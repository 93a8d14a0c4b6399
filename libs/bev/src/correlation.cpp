// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/bev/correlation.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "loopmark/bev/fft2d.hpp"
#include "loopmark/core/parallel.hpp"

namespace loopmark::bev {
namespace {

constexpr std::size_t kBlock = 8;  // cells; one peak a block
constexpr std::size_t kPeaksPerSurface = 12;
constexpr float kFullBand = 100.0F;   // cells; a band of so many counts half
constexpr float kSmallPower = 1e-3F;  // keeps empty frequencies from dividing by zero

/// Gaussian smoothing as one factor per frequency; the mean is removed.
std::vector<float> smoothing(const CorrelationOptions& options) {
  const std::size_t side = options.side;
  const double sigma = options.blur_m / options.cell_m;
  std::vector<double> axis(side);
  for (std::size_t k = 0; k < side; ++k) {
    const double f = static_cast<double>(std::min(k, side - k)) / static_cast<double>(side);
    axis[k] = std::exp(-2.0 * std::numbers::pi * std::numbers::pi * sigma * sigma * f * f);
  }
  std::vector<float> gain(side * side);
  for (std::size_t y = 0; y < side; ++y) {
    for (std::size_t x = 0; x < side; ++x) {
      gain[y * side + x] = static_cast<float>(axis[y] * axis[x]);
    }
  }
  gain[0] = 0.0F;
  return gain;
}

/// A point of a layer: x, y in metres, and what is drawn there.
using Layer = std::vector<Eigen::Vector3f>;
constexpr std::size_t kLayers = kBands + 1;

/// One layer a height band, drawn as ones, and the relief of the ground.
std::array<Layer, kLayers> layers_of(const BirdseyeView& view) {
  std::array<Layer, kLayers> layers;
  for (const StructureCell& cell : view.structure) {
    for (std::size_t band = 0; band < kBands; ++band) {
      if ((cell.bands >> band & 1U) != 0) {
        layers[band].emplace_back(cell.x, cell.y, 1.0F);
      }
    }
  }
  for (const ReliefCell& cell : view.relief) {
    layers[kBands].emplace_back(cell.x, cell.y, cell.relief / kMostRelief);
  }
  return layers;
}

/// Whitening gives every layer the same energy; a band of a few cells must not speak as loud as a full one.
float layer_weight(const Layer& source, const Layer& target) {
  const auto cells = static_cast<float>(std::min(source.size(), target.size()));
  return cells / (cells + kFullBand);
}

/// 1 / |.|: only the phase stays.
inline float whitening(float re, float im) { return 1.0F / std::sqrt(re * re + im * im + kSmallPower); }

/// Real and imaginary parts of a row of a spectrum.
template <class Float>
struct Row {
  Float* __restrict re;
  Float* __restrict im;
};

/// Z = A + iB holds the spectra of two real images: A = (Z[k] + conj Z[-k]) / 2, B = (Z[k] - conj Z[-k]) / 2i. Adds the
/// spectra of the packed surfaces P + iQ: for the images as drawn, P = T conj(A) / |A|, Q = T conj(B) / |B|; for both
/// turned by pi, P = T A / |A|, Q = T B / |B|. T is the target's, whitened already.
__attribute__((target_clones("avx2", "default"))) void multiply_row(Row<const float> z, Row<const float> mirrored,
                                                                    Row<const float> target, Row<float> drawn,
                                                                    Row<float> turned, std::size_t side) {
  for (std::size_t x = 0; x < side; ++x) {
    const float a_re = 0.5F * (z.re[x] + mirrored.re[x]);
    const float a_im = 0.5F * (z.im[x] - mirrored.im[x]);
    const float b_re = 0.5F * (z.im[x] + mirrored.im[x]);
    const float b_im = 0.5F * (mirrored.re[x] - z.re[x]);
    const float wa = 1.0F / std::sqrt(a_re * a_re + a_im * a_im + kSmallPower);
    const float wb = 1.0F / std::sqrt(b_re * b_re + b_im * b_im + kSmallPower);
    const float a_rr = wa * target.re[x] * a_re;
    const float a_ii = wa * target.im[x] * a_im;
    const float a_ir = wa * target.im[x] * a_re;
    const float a_ri = wa * target.re[x] * a_im;
    const float b_rr = wb * target.re[x] * b_re;
    const float b_ii = wb * target.im[x] * b_im;
    const float b_ir = wb * target.im[x] * b_re;
    const float b_ri = wb * target.re[x] * b_im;
    drawn.re[x] += (a_rr + a_ii) - (b_ir - b_ri);
    drawn.im[x] += (a_ir - a_ri) + (b_rr + b_ii);
    turned.re[x] += (a_rr - a_ii) - (b_ir + b_ri);
    turned.im[x] += (a_ir + a_ri) + (b_rr - b_ii);
  }
}

/// Element -x of a periodic row for each x.
void read_backwards(const float* row, std::size_t side, float* to) {
  to[0] = row[0];
  std::reverse_copy(row + 1, row + side, to + 1);
}

/// The surfaces of one correlation run: what is constant over the yaws.
class Correlator {
 public:
  Correlator(const BirdseyeView& source, const BirdseyeView& target, const CorrelationOptions& options)
      : options_(options), fft_(options.side), source_(layers_of(source)) {
    const std::vector<float> gain = smoothing(options);
    const auto layers = layers_of(target);
    for (std::size_t i = 0; i < kLayers; ++i) {
      const float weight =
          layer_weight(source_[i], layers[i]) * (i == kBands ? static_cast<float>(options.relief_weight) : 1.0F);
      if (weight <= 0.0F) {
        continue;
      }
      used_.push_back(i);
      ComplexGrid& spectrum = targets_.emplace_back(options.side);
      draw(layers[i], 0.0, spectrum.re);
      fft_.forward(spectrum);
      for (std::size_t k = 0; k < gain.size(); ++k) {
        const float scale = weight * gain[k] * whitening(spectrum.re[k], spectrum.im[k]);
        spectrum.re[k] *= scale;
        spectrum.im[k] *= scale;
      }
    }
  }

  /// The correlation surfaces of four yaws at once: a and b in the real and the imaginary part of the first grid, a +
  /// pi and b + pi in those of the second. Turning an image by pi conjugates its spectrum, which is drawn only once.
  std::array<ComplexGrid, 2> surfaces(double yaw_a, double yaw_b) const {
    std::array<ComplexGrid, 2> sums = {ComplexGrid(options_.side), ComplexGrid(options_.side)};
    ComplexGrid grid(options_.side);
    for (std::size_t i = 0; i < used_.size(); ++i) {
      std::fill(grid.re.begin(), grid.re.end(), 0.0F);
      std::fill(grid.im.begin(), grid.im.end(), 0.0F);
      draw(source_[used_[i]], yaw_a, grid.re);
      draw(source_[used_[i]], yaw_b, grid.im);
      fft_.forward(grid);
      multiply(grid, targets_[i], sums);
    }
    fft_.inverse(sums[0]);
    fft_.inverse(sums[1]);
    return sums;
  }

 private:
  /// Bilinear drawing of the turned points. What leaves the grid comes in again on the other side: the correlation is
  /// periodic anyway, and the peaks are unfolded.
  void draw(const Layer& layer, double yaw, std::vector<float>& image) const {
    const auto c = static_cast<float>(std::cos(yaw) / options_.cell_m);
    const auto s = static_cast<float>(std::sin(yaw) / options_.cell_m);
    const int mask = static_cast<int>(options_.side) - 1;
    for (const Eigen::Vector3f& point : layer) {
      const float gx = c * point.x() - s * point.y();
      const float gy = s * point.x() + c * point.y();
      const float fx = std::floor(gx);
      const float fy = std::floor(gy);
      const float ax = gx - fx;
      const float ay = point.z() * (gy - fy);
      const float by = point.z() - ay;
      const int x0 = static_cast<int>(fx) & mask;
      const int x1 = (x0 + 1) & mask;
      const auto y0 = static_cast<std::size_t>(static_cast<int>(fy) & mask) * options_.side;
      const auto y1 = static_cast<std::size_t>((static_cast<int>(fy) + 1) & mask) * options_.side;
      image[y0 + static_cast<std::size_t>(x0)] += (1.0F - ax) * by;
      image[y0 + static_cast<std::size_t>(x1)] += ax * by;
      image[y1 + static_cast<std::size_t>(x0)] += (1.0F - ax) * ay;
      image[y1 + static_cast<std::size_t>(x1)] += ax * ay;
    }
  }

  /// Parts the two real images' spectra, whitens them and multiplies their conjugates with the target's.
  void multiply(const ComplexGrid& grid, const ComplexGrid& target, std::array<ComplexGrid, 2>& sums) const {
    const std::size_t side = options_.side;
    std::vector<float> mirrored(2 * side);  // row -y of the grid, read backwards
    for (std::size_t y = 0; y < side; ++y) {
      const std::size_t row = y * side;
      const std::size_t opposite = ((side - y) % side) * side;
      read_backwards(&grid.re[opposite], side, mirrored.data());
      read_backwards(&grid.im[opposite], side, mirrored.data() + side);
      multiply_row({&grid.re[row], &grid.im[row]}, {mirrored.data(), mirrored.data() + side},
                   {&target.re[row], &target.im[row]}, {&sums[0].re[row], &sums[0].im[row]},
                   {&sums[1].re[row], &sums[1].im[row]}, side);
    }
  }

  CorrelationOptions options_;
  Fft2d fft_;
  std::array<Layer, kLayers> source_;
  std::vector<std::size_t> used_;     ///< layers that both scans have
  std::vector<ComplexGrid> targets_;  ///< their whitened and weighted spectra
};

struct Peak {
  float value = 0.0F;
  std::size_t x = 0;
  std::size_t y = 0;
};

/// The highest value of each block of a row of blocks; `rows`: kBlock rows of the surface.
__attribute__((target_clones("avx2", "default"))) void highest_of_blocks(const float* rows, std::size_t side,
                                                                         float* across, float* highest) {
  std::copy(rows, rows + side, across);
  for (std::size_t y = 1; y < kBlock; ++y) {
    for (std::size_t x = 0; x < side; ++x) {
      across[x] = rows[y * side + x] > across[x] ? rows[y * side + x] : across[x];
    }
  }
  for (std::size_t b = 0; b < side / kBlock; ++b) {
    highest[b] = *std::max_element(across + b * kBlock, across + (b + 1) * kBlock);
  }
}

/// The first cell of a block, row by row, that has a value.
Peak cell_with(float value, const std::vector<float>& surface, std::size_t side, std::size_t bx, std::size_t by) {
  for (std::size_t y = by; y < by + kBlock; ++y) {
    const float* row = &surface[y * side + bx];
    const float* found = std::find(row, row + kBlock, value);
    if (found != row + kBlock) {
      return {value, bx + static_cast<std::size_t>(found - row), y};
    }
  }
  return {value, bx, by};
}

/// The highest cells of a surface, at most one a block.
std::vector<Peak> highest(const std::vector<float>& surface, std::size_t side) {
  std::vector<float> across(side);
  std::vector<float> of_blocks(side / kBlock);
  std::vector<Peak> peaks;  // at first those of the blocks' corners
  for (std::size_t by = 0; by < side; by += kBlock) {
    highest_of_blocks(&surface[by * side], side, across.data(), of_blocks.data());
    for (std::size_t b = 0; b < of_blocks.size(); ++b) {
      peaks.push_back({of_blocks[b], b * kBlock, by});
    }
  }
  const auto last = peaks.begin() + static_cast<std::ptrdiff_t>(std::min(kPeaksPerSurface, peaks.size()));
  std::partial_sort(peaks.begin(), last, peaks.end(), [](const Peak& a, const Peak& b) {
    return a.value != b.value ? a.value > b.value : a.y * 65536 + a.x < b.y * 65536 + b.x;
  });
  peaks.erase(last, peaks.end());
  for (Peak& peak : peaks) {
    peak = cell_with(peak.value, surface, side, peak.x, peak.y);
  }
  return peaks;
}

/// Root mean square; eight running sums, so that the compiler may use vectors.
double spread(const std::vector<float>& surface) {
  std::array<float, 8> squares{};
  for (std::size_t i = 0; i < surface.size(); i += 8) {
    for (std::size_t j = 0; j < 8; ++j) {
      squares[j] += surface[i + j] * surface[i + j];
    }
  }
  double sum = 0.0;
  for (const float part : squares) {
    sum += static_cast<double>(part);
  }
  return std::sqrt(sum / static_cast<double>(surface.size())) + 1e-12;
}

void append_peaks(const std::vector<float>& surface, double yaw, const CorrelationOptions& options,
                  std::vector<PlanarHypothesis>& found) {
  const auto side = static_cast<double>(options.side);
  const auto metres = [&](std::size_t cell) {
    const auto c = static_cast<double>(cell);
    return (c < side / 2.0 ? c : c - side) * options.cell_m;
  };
  const double sigma = spread(surface);
  for (const Peak& peak : highest(surface, options.side)) {
    found.push_back({yaw, metres(peak.x), metres(peak.y), static_cast<double>(peak.value) / sigma});
  }
}

double turn_between(double a, double b) { return std::abs(std::remainder(a - b, 2.0 * std::numbers::pi)); }

std::vector<PlanarHypothesis> distinct(std::vector<PlanarHypothesis> all, const CorrelationOptions& options) {
  std::stable_sort(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.score > b.score; });
  std::vector<PlanarHypothesis> kept;
  const double turn = options.distinct_deg * std::numbers::pi / 180.0;
  for (const PlanarHypothesis& h : all) {
    const bool known = std::any_of(kept.begin(), kept.end(), [&](const PlanarHypothesis& k) {
      return std::hypot(h.x - k.x, h.y - k.y) < options.distinct_m && turn_between(h.yaw, k.yaw) < turn;
    });
    if (!known) {
      kept.push_back(h);
      if (kept.size() == options.peaks) {
        break;
      }
    }
  }
  return kept;
}

/// A shift along one axis and its like, one side of the grid away, where that is not too long.
std::vector<double> unfolded(double shift, const CorrelationOptions& options) {
  const double other = shift - std::copysign(static_cast<double>(options.side) * options.cell_m, shift);
  return std::abs(other) <= options.longest_shift_m ? std::vector<double>{shift, other} : std::vector<double>{shift};
}

/// Every shift that the peaks may stand for.
std::vector<PlanarHypothesis> unfolded(const std::vector<PlanarHypothesis>& peaks, const CorrelationOptions& options) {
  std::vector<PlanarHypothesis> all;
  for (const PlanarHypothesis& peak : peaks) {
    for (const double y : unfolded(peak.y, options)) {
      for (const double x : unfolded(peak.x, options)) {
        all.push_back({peak.yaw, x, y, peak.score});
      }
    }
  }
  return all;
}

}  // namespace

std::vector<PlanarHypothesis> correlate(const BirdseyeView& source, const BirdseyeView& target,
                                        const CorrelationOptions& options) {
  if (source.structure.empty() || target.structure.empty()) {
    return {};
  }
  const Correlator correlator(source, target, options);
  const auto groups = static_cast<std::size_t>(std::ceil(90.0 / options.yaw_step_deg));
  const double step = std::numbers::pi / static_cast<double>(2 * groups);
  std::vector<std::vector<PlanarHypothesis>> found(groups);
  parallel_for(groups, [&](std::size_t i) {
    const double yaw_a = static_cast<double>(2 * i) * step;
    const double yaw_b = yaw_a + step;
    const auto surfaces = correlator.surfaces(yaw_a, yaw_b);
    for (std::size_t half = 0; half < 2; ++half) {
      const double turn = half == 0 ? 0.0 : std::numbers::pi;
      append_peaks(surfaces[half].re, yaw_a + turn, options, found[i]);
      append_peaks(surfaces[half].im, yaw_b + turn, options, found[i]);
    }
  });
  std::vector<PlanarHypothesis> all;
  for (const auto& part : found) {
    all.insert(all.end(), part.begin(), part.end());
  }
  return unfolded(distinct(std::move(all), options), options);
}

}  // namespace loopmark::bev
