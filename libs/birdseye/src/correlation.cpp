// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/birdseye/correlation.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "loopmark/birdseye/fft2d.hpp"
#include "loopmark/core/parallel.hpp"

namespace loopmark::birdseye {
namespace {

constexpr std::size_t kBlock = 8;  // cells; one peak a block
constexpr std::size_t kPeaksPerSurface = 4;
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

/// The surfaces of one correlation run: what is constant over the yaws.
class Correlator {
 public:
  Correlator(const std::vector<StructureCell>& target, const CorrelationOptions& options)
      : options_(options), fft_(options.side), gain_(smoothing(options)), targets_(kBands, ComplexGrid(options.side)) {
    for (std::size_t band = 0; band < kBands; ++band) {
      ComplexGrid& spectrum = targets_[band];
      draw(target, 0.0, band, spectrum.re);
      fft_.forward(spectrum);
      for (std::size_t k = 0; k < gain_.size(); ++k) {
        const float scale = gain_[k] * whitening(spectrum.re[k], spectrum.im[k]);
        spectrum.re[k] *= scale;
        spectrum.im[k] *= scale;
      }
    }
  }

  /// The correlation surfaces of two yaws at once: the first in the real part, the second in the imaginary part.
  ComplexGrid surfaces(const std::vector<StructureCell>& source, double yaw_a, double yaw_b) const {
    ComplexGrid sum(options_.side);
    for (std::size_t band = 0; band < kBands; ++band) {
      ComplexGrid grid(options_.side);
      draw(source, yaw_a, band, grid.re);
      draw(source, yaw_b, band, grid.im);
      fft_.forward(grid);
      multiply(grid, targets_[band], sum);
    }
    fft_.inverse(sum);
    return sum;
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
  void multiply(const ComplexGrid& grid, const ComplexGrid& target, ComplexGrid& sum) const {
    const std::size_t side = options_.side;
    for (std::size_t y = 0; y < side; ++y) {
      const std::size_t my = (side - y) % side;
      for (std::size_t x = 0; x < side; ++x) {
        const std::size_t k = y * side + x;
        const std::size_t m = my * side + (side - x) % side;
        if (m < k) {
          continue;
        }
        multiply_pair(grid, target, k, m, sum);
      }
    }
  }

  void multiply_pair(const ComplexGrid& z, const ComplexGrid& target, std::size_t k, std::size_t m,
                     ComplexGrid& sum) const {
    // A = (Z[k] + conj Z[m]) / 2, B = (Z[k] - conj Z[m]) / 2i; A[m] = conj A[k], B[m] = conj B[k].
    const float a_re = 0.5F * (z.re[k] + z.re[m]);
    const float a_im = 0.5F * (z.im[k] - z.im[m]);
    const float b_re = 0.5F * (z.im[k] + z.im[m]);
    const float b_im = 0.5F * (z.re[m] - z.re[k]);
    const float wa = whitening(a_re, a_im);
    const float wb = whitening(b_re, b_im);
    const float t_re = target.re[k];
    const float t_im = target.im[k];
    // P = T conj(A) wa, Q = T conj(B) wb.
    const float p_re = wa * (t_re * a_re + t_im * a_im);
    const float p_im = wa * (t_im * a_re - t_re * a_im);
    const float q_re = wb * (t_re * b_re + t_im * b_im);
    const float q_im = wb * (t_im * b_re - t_re * b_im);
    // Z[k] = P + iQ; at m both are conjugated.
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

double spread(const std::vector<float>& surface) {
  double squares = 0.0;
  for (const float value : surface) {
    squares += static_cast<double>(value) * static_cast<double>(value);
  }
  return std::sqrt(squares / static_cast<double>(surface.size())) + 1e-12;
}

std::vector<PlanarHypothesis> hypotheses_of(const std::vector<float>& surface, double yaw,
                                            const CorrelationOptions& options) {
  const auto side = static_cast<double>(options.side);
  const auto metres = [&](std::size_t cell) {
    const auto c = static_cast<double>(cell);
    return (c < side / 2.0 ? c : c - side) * options.cell_m;
  };
  std::vector<PlanarHypothesis> found;
  const double sigma = spread(surface);
  for (const Peak& peak : highest(surface, options.side)) {
    found.push_back({yaw, metres(peak.x), metres(peak.y), static_cast<double>(peak.value) / sigma});
  }
  return found;
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
  const Correlator correlator(target, options);
  const auto pairs = static_cast<std::size_t>(std::ceil(180.0 / options.yaw_step_deg));
  const double step = std::numbers::pi / static_cast<double>(pairs);
  std::vector<std::vector<PlanarHypothesis>> found(pairs);
  parallel_for(pairs, [&](std::size_t i) {
    const double yaw = static_cast<double>(i) * step;
    const ComplexGrid surfaces = correlator.surfaces(source, yaw, yaw + std::numbers::pi);
    found[i] = hypotheses_of(surfaces.re, yaw, options);
    const auto opposite = hypotheses_of(surfaces.im, yaw + std::numbers::pi, options);
    found[i].insert(found[i].end(), opposite.begin(), opposite.end());
  });
  std::vector<PlanarHypothesis> all;
  for (const auto& part : found) {
    all.insert(all.end(), part.begin(), part.end());
  }
  return distinct(std::move(all), options);
}

}  // namespace loopmark::birdseye
