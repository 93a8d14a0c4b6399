// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/birdseye/correlation.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "loopmark/birdseye/fft2d.hpp"
#include "loopmark/core/parallel.hpp"

namespace loopmark::birdseye {
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

std::size_t cells_in_band(const std::vector<StructureCell>& cells, std::size_t band) {
  return static_cast<std::size_t>(
      std::count_if(cells.begin(), cells.end(), [&](const StructureCell& c) { return (c.bands >> band & 1U) != 0; }));
}

/// Whitening gives every band the same energy; a band of a few cells must not speak as loud as a full one.
float band_weight(const std::vector<StructureCell>& source, const std::vector<StructureCell>& target,
                  std::size_t band) {
  const auto cells = static_cast<float>(std::min(cells_in_band(source, band), cells_in_band(target, band)));
  return cells / (cells + kFullBand);
}

/// The surfaces of one correlation run: what is constant over the yaws.
class Correlator {
 public:
  Correlator(const std::vector<StructureCell>& source, const std::vector<StructureCell>& target,
             const CorrelationOptions& options)
      : options_(options), fft_(options.side), gain_(smoothing(options)), targets_(kBands, ComplexGrid(options.side)) {
    for (std::size_t band = 0; band < kBands; ++band) {
      ComplexGrid& spectrum = targets_[band];
      draw(target, 0.0, band, spectrum.re);
      fft_.forward(spectrum);
      const float weight = band_weight(source, target, band);
      for (std::size_t k = 0; k < gain_.size(); ++k) {
        const float scale = weight * gain_[k] * whitening(spectrum.re[k], spectrum.im[k]);
        spectrum.re[k] *= scale;
        spectrum.im[k] *= scale;
      }
    }
  }

  /// The correlation surfaces of four yaws at once: a and b in the real and the imaginary part of the first grid, a +
  /// pi and b + pi in those of the second. Turning an image by pi conjugates its spectrum, which is drawn only once.
  std::array<ComplexGrid, 2> surfaces(const std::vector<StructureCell>& source, double yaw_a, double yaw_b) const {
    std::array<ComplexGrid, 2> sums = {ComplexGrid(options_.side), ComplexGrid(options_.side)};
    ComplexGrid grid(options_.side);
    for (std::size_t band = 0; band < kBands; ++band) {
      std::fill(grid.re.begin(), grid.re.end(), 0.0F);
      std::fill(grid.im.begin(), grid.im.end(), 0.0F);
      draw(source, yaw_a, band, grid.re);
      draw(source, yaw_b, band, grid.im);
      fft_.forward(grid);
      multiply(grid, targets_[band], sums);
    }
    fft_.inverse(sums[0]);
    fft_.inverse(sums[1]);
    return sums;
  }

 private:
  /// 1 / |.|: only the phase stays.
  static float whitening(float re, float im) { return 1.0F / std::sqrt(re * re + im * im + kSmallPower); }

  /// Bilinear drawing of the turned cells; whatever leaves the grid is dropped.
  void draw(const std::vector<StructureCell>& cells, double yaw, std::size_t band, std::vector<float>& image) const {
    const auto c = static_cast<float>(std::cos(yaw) / options_.cell_m);
    const auto s = static_cast<float>(std::sin(yaw) / options_.cell_m);
    const auto side = static_cast<int>(options_.side);
    const float half = static_cast<float>(side) / 2.0F;
    for (const StructureCell& cell : cells) {
      if ((cell.bands >> band & 1U) == 0) {
        continue;
      }
      const float gx = c * cell.x - s * cell.y + half;
      const float gy = s * cell.x + c * cell.y + half;
      const int ix = static_cast<int>(std::floor(gx));
      const int iy = static_cast<int>(std::floor(gy));
      if (ix < 0 || iy < 0 || ix + 1 >= side || iy + 1 >= side) {
        continue;
      }
      const float ax = gx - static_cast<float>(ix);
      const float ay = gy - static_cast<float>(iy);
      float* row = image.data() + static_cast<std::size_t>(iy * side + ix);
      row[0] += (1.0F - ax) * (1.0F - ay);
      row[1] += ax * (1.0F - ay);
      row[side] += (1.0F - ax) * ay;
      row[side + 1] += ax * ay;
    }
  }

  /// Parts the two real images' spectra, whitens them and multiplies their conjugates with the target's.
  void multiply(const ComplexGrid& grid, const ComplexGrid& target, std::array<ComplexGrid, 2>& sums) const {
    const std::size_t side = options_.side;
    for (std::size_t y = 0; y < side; ++y) {
      const std::size_t my = (side - y) % side;
      for (std::size_t x = 0; x < side; ++x) {
        const std::size_t k = y * side + x;
        const std::size_t m = my * side + (side - x) % side;
        if (m < k) {
          continue;
        }
        multiply_pair(grid, target, k, m, sums);
      }
    }
  }

  void multiply_pair(const ComplexGrid& z, const ComplexGrid& target, std::size_t k, std::size_t m,
                     std::array<ComplexGrid, 2>& sums) const {
    // A = (Z[k] + conj Z[m]) / 2, B = (Z[k] - conj Z[m]) / 2i; A[m] = conj A[k], B[m] = conj B[k].
    const float a_re = 0.5F * (z.re[k] + z.re[m]);
    const float a_im = 0.5F * (z.im[k] - z.im[m]);
    const float b_re = 0.5F * (z.im[k] + z.im[m]);
    const float b_im = 0.5F * (z.re[m] - z.re[k]);
    const float wa = whitening(a_re, a_im);
    const float wb = whitening(b_re, b_im);
    const float t_re = target.re[k];
    const float t_im = target.im[k];
    // T conj(A) and T A share their products; likewise for B.
    const float a_rr = wa * t_re * a_re;
    const float a_ii = wa * t_im * a_im;
    const float a_ir = wa * t_im * a_re;
    const float a_ri = wa * t_re * a_im;
    const float b_rr = wb * t_re * b_re;
    const float b_ii = wb * t_im * b_im;
    const float b_ir = wb * t_im * b_re;
    const float b_ri = wb * t_re * b_im;
    add(sums[0], k, m, a_rr + a_ii, a_ir - a_ri, b_rr + b_ii, b_ir - b_ri);
    add(sums[1], k, m, a_rr - a_ii, a_ir + a_ri, b_rr - b_ii, b_ir + b_ri);
  }

  /// Adds the spectrum P + iQ of the packed surfaces at k, and at -k, where P and Q are conjugated.
  static void add(ComplexGrid& sum, std::size_t k, std::size_t m, float p_re, float p_im, float q_re, float q_im) {
    sum.re[k] += p_re - q_im;
    sum.im[k] += p_im + q_re;
    if (m != k) {
      sum.re[m] += p_re + q_im;
      sum.im[m] += q_re - p_im;
    }
  }

  CorrelationOptions options_;
  Fft2d fft_;
  std::vector<float> gain_;
  std::vector<ComplexGrid> targets_;  ///< whitened spectra, one a band
};

struct Peak {
  float value = 0.0F;
  std::size_t x = 0;
  std::size_t y = 0;
};

/// The highest cells of a surface, at most one a block.
std::vector<Peak> highest(const std::vector<float>& surface, std::size_t side) {
  std::vector<Peak> peaks;
  for (std::size_t by = 0; by < side; by += kBlock) {
    for (std::size_t bx = 0; bx < side; bx += kBlock) {
      Peak best{surface[by * side + bx], bx, by};
      for (std::size_t y = by; y < by + kBlock; ++y) {
        for (std::size_t x = bx; x < bx + kBlock; ++x) {
          if (surface[y * side + x] > best.value) {
            best = {surface[y * side + x], x, y};
          }
        }
      }
      peaks.push_back(best);
    }
  }
  const auto last = peaks.begin() + static_cast<std::ptrdiff_t>(std::min(kPeaksPerSurface, peaks.size()));
  std::partial_sort(peaks.begin(), last, peaks.end(), [](const Peak& a, const Peak& b) {
    return a.value != b.value ? a.value > b.value : a.y * 65536 + a.x < b.y * 65536 + b.x;
  });
  peaks.erase(last, peaks.end());
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

}  // namespace

std::vector<PlanarHypothesis> correlate(const std::vector<StructureCell>& source,
                                        const std::vector<StructureCell>& target, const CorrelationOptions& options) {
  if (source.empty() || target.empty()) {
    return {};
  }
  const Correlator correlator(source, target, options);
  const auto groups = static_cast<std::size_t>(std::ceil(90.0 / options.yaw_step_deg));
  const double step = std::numbers::pi / static_cast<double>(2 * groups);
  std::vector<std::vector<PlanarHypothesis>> found(groups);
  parallel_for(groups, [&](std::size_t i) {
    const double yaw_a = static_cast<double>(2 * i) * step;
    const double yaw_b = yaw_a + step;
    const auto surfaces = correlator.surfaces(source, yaw_a, yaw_b);
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
  return distinct(std::move(all), options);
}

}  // namespace loopmark::birdseye
