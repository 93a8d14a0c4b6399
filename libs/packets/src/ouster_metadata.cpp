// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "ouster_metadata.hpp"

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numbers>

#include "loopmark/core/error.hpp"

namespace loopmark::packets::internal {
namespace {

using Json = nlohmann::json;

constexpr std::size_t kMostBytes = std::size_t{16} << 20U;  // of a metadata file; real ones have some 10 kB

/// The sections of new firmware by the name that a value's place has in old files: there everything lies on the top
/// level but data_format.
class Reader {
 public:
  Reader(const std::filesystem::path& file, Json json) : file_(file), json_(std::move(json)) {
    if (!json_.is_object()) {
      fail("is no JSON object");
    }
    sections_ =
        json_.contains("sensor_info") || json_.contains("lidar_data_format") || json_.contains("beam_intrinsics");
    if (sections_ && json_.contains("prod_line")) {
      fail("mixes the old form (prod_line on the top level) with the new one (sections)");
    }
    if (sections_) {
      for (const char* section :
           {"sensor_info", "config_params", "lidar_data_format", "beam_intrinsics", "lidar_intrinsics"}) {
        if (!json_.contains(section)) {
          fail(std::string("the section '") + section + "' is missing");
        }
      }
    }
  }

  [[noreturn]] void fail(const std::string& problem) const {
    throw InputError(file_.string(), "", problem,
                     "give the sensor's metadata as its driver or web page writes it, whole and unchanged");
  }

  /// nullptr where it is missing.
  const Json* find(const char* section, const char* name) const {
    const Json* where = &json_;
    const std::string old_section = std::string(section) == "lidar_data_format" ? "data_format" : "";
    const std::string wanted = sections_ ? section : old_section;
    if (!wanted.empty()) {
      if (!json_.contains(wanted) || !json_[wanted].is_object()) {
        return nullptr;
      }
      where = &json_[wanted];
    }
    const auto found = where->find(name);
    return found == where->end() || found->is_null() ? nullptr : &*found;
  }
  bool has_data_format() const { return json_.contains(sections_ ? "lidar_data_format" : "data_format"); }

  std::size_t whole(const char* section, const char* name, std::size_t most) const {
    const Json* value = find(section, name);
    if (value == nullptr) {
      fail(std::string("'") + name + "' is missing");
    }
    if (!value->is_number_unsigned() || value->get<std::uint64_t>() == 0 || value->get<std::uint64_t>() > most) {
      fail(std::string("'") + name + "' makes no sense: " + value->dump().substr(0, 40));
    }
    return value->get<std::size_t>();
  }

  double number(const char* section, const char* name) const {
    const Json* value = find(section, name);
    if (value == nullptr || !value->is_number()) {
      fail(std::string("'") + name + "' is no number");
    }
    return value->get<double>();
  }

  std::string text(const char* section, const char* name, const std::string& otherwise) const {
    const Json* value = find(section, name);
    return value != nullptr && value->is_string() ? value->get<std::string>() : otherwise;
  }

  std::vector<double> numbers(const char* section, const char* name) const {
    const Json* value = find(section, name);
    if (value == nullptr || !value->is_array()) {
      fail(std::string("the list '") + name + "' is missing");
    }
    std::vector<double> list;
    for (const Json& entry : *value) {
      if (entry.is_number()) {
        list.push_back(entry.get<double>());
      } else if (entry.is_array()) {  // nested by columns in the newest firmware
        for (const Json& inner : entry) {
          list.push_back(inner.is_number() ? inner.get<double>() : std::nan(""));
        }
      }
    }
    return list;
  }

 private:
  std::filesystem::path file_;
  Json json_;
  bool sections_ = false;
};

Json parsed(const std::filesystem::path& file) {
  std::error_code error;
  if (std::filesystem::file_size(file, error) > kMostBytes || error) {
    throw InputError(file.string(), "", error ? "cannot be read" : "is too large for a sensor's metadata");
  }
  try {
    std::ifstream in(file);
    return Json::parse(in);
  } catch (const Json::exception& problem) {
    throw InputError(file.string(), "", std::string("is no JSON: ") + problem.what());
  }
}

/// "1024x10": columns and frames a second.
void take_mode(OusterMetadata& m, const Reader& reader) {
  const std::string mode = reader.text("config_params", "lidar_mode", "");
  const std::size_t x = mode.find('x');
  if (x == std::string::npos) {
    return;
  }
  const int columns = std::atoi(mode.c_str());
  const int rate = std::atoi(mode.c_str() + x + 1);
  if (rate > 0 && rate <= 20) {
    m.frames_per_s = rate;
  }
  if (columns > 0 && m.columns != 0 && static_cast<std::size_t>(columns) != m.columns) {
    reader.fail("columns_per_frame is " + std::to_string(m.columns) + " but lidar_mode is " + mode);
  }
  if (m.columns == 0 && columns > 0 && columns <= 4096) {
    m.columns = static_cast<std::size_t>(columns);
  }
}

void take_beams(OusterMetadata& m, const Reader& reader) {
  const auto radians = [](std::vector<double> degrees) {
    for (double& value : degrees) {
      value *= std::numbers::pi / 180.0;
    }
    return degrees;
  };
  m.elevation_rad = radians(reader.numbers("beam_intrinsics", "beam_altitude_angles"));
  m.azimuth_rad = radians(reader.numbers("beam_intrinsics", "beam_azimuth_angles"));
  if (m.elevation_rad.size() != m.azimuth_rad.size()) {
    reader.fail(std::to_string(m.elevation_rad.size()) + " beam_altitude_angles but " +
                std::to_string(m.azimuth_rad.size()) + " beam_azimuth_angles");
  }
  if (m.rows == 0) {
    m.rows = m.elevation_rad.size();
  }
  if (m.elevation_rad.size() != m.rows) {
    reader.fail(std::to_string(m.elevation_rad.size()) + " beams but " + std::to_string(m.rows) +
                " pixels in a column");
  }
  const bool all_zero = std::all_of(m.elevation_rad.begin(), m.elevation_rad.end(), [](double v) { return v == 0.0; });
  if (m.rows == 0 || (m.rows > 1 && all_zero)) {
    reader.fail("all beam_altitude_angles are 0: the sensor's calibration is missing");
  }
}

void take_transforms(OusterMetadata& m, const Reader& reader) {
  if (reader.find("beam_intrinsics", "lidar_origin_to_beam_origin_mm") != nullptr) {
    m.beam_origin_m = 1e-3 * reader.number("beam_intrinsics", "lidar_origin_to_beam_origin_mm");
  } else if (m.product.find("OS-0") == 0) {  // the values that the drivers take for firmware before 2.0
    m.beam_origin_m = 0.02767;
  } else {
    m.beam_origin_m = m.product.find("OS-2") == 0 ? 0.013762 : 0.015806;
  }
  const std::vector<double> v = reader.numbers("lidar_intrinsics", "lidar_to_sensor_transform");
  if (v.size() != 16) {
    reader.fail("lidar_to_sensor_transform has " + std::to_string(v.size()) + " numbers, not 16");
  }
  Eigen::Matrix4d matrix = Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(v.data());
  matrix.topRightCorner<3, 1>() *= 1e-3;
  try {
    m.T_sensor_lidar = rigid_from_matrix(matrix, 1e-3);
  } catch (const std::invalid_argument& problem) {
    reader.fail(std::string("lidar_to_sensor_transform: ") + problem.what());
  }
}

}  // namespace

OusterMetadata read_ouster_metadata(const std::filesystem::path& file) {
  const Reader reader(file, parsed(file));
  OusterMetadata m;
  m.product = reader.text("sensor_info", "prod_line", "");
  if (m.product.empty()) {
    reader.fail("'prod_line' is missing: this is no metadata of an Ouster sensor");
  }
  m.profile = reader.text("lidar_data_format", "udp_profile_lidar", "LEGACY");
  m.columns_in_packet = 16;
  if (reader.has_data_format()) {
    m.rows = reader.whole("lidar_data_format", "pixels_per_column", 256);
    m.columns = reader.whole("lidar_data_format", "columns_per_frame", 8192);
    m.columns_in_packet = reader.whole("lidar_data_format", "columns_per_packet", 64);
  }
  take_mode(m, reader);
  if (m.columns == 0) {
    reader.fail("neither data_format nor lidar_mode says how many columns a frame has");
  }
  take_beams(m, reader);
  take_transforms(m, reader);
  return m;
}

}  // namespace loopmark::packets::internal
