// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "convert_command.hpp"

#include <cstdio>
#include <memory>

#include "loopmark/io/log_writer.hpp"

namespace loopmark::app {
namespace {

struct ConvertArguments {
  std::filesystem::path log;
  std::filesystem::path output;
  std::string format;
  io::ConvertOptions options;
};

constexpr const char* kExamples = R"(Examples:
  loopmark convert drive.bag -o drive.mcap                     a ROS 1 bag as MCAP, for Foxglove
  loopmark convert capture.pcap -o drive --format pcd          packets as a folder of scans with ring and time
  loopmark convert drives/day1 -o day1.bag --from 60 --to 90   half a minute of a folder as a ROS 1 bag
Scans keep intensity, ring and times; IMU, GNSS, odometry and reference poses go along where the format has a place for
them (mcap, rosbag1, rosbag2). Nothing is overwritten.)";

/// What the output's name says.
std::string format_of(const std::filesystem::path& output) {
  const std::string extension = output.extension().string();
  return extension == ".mcap" ? "mcap" : extension == ".bag" ? "rosbag1" : "";
}

int convert(const ConvertArguments& a, const Globals& globals) {
  const std::string format = a.format.empty() ? format_of(a.output) : a.format;
  if (format.empty()) {
    throw InputError("loopmark convert needs --format: kitti, pcd, mcap, rosbag1 or rosbag2");
  }
  const auto log = io::open_log(a.log, globals.options().log);
  const auto writer = io::create_log_writer(format, a.output);
  const io::ConvertedLog done = io::convert_log(*log, *writer, a.options);
  std::printf("%s: %zu scans, %zu of IMU, GNSS and odometry (%s)\n", a.output.c_str(), done.scans, done.observations,
              format.c_str());
  for (const std::string& problem : done.problems) {
    std::printf("  left out: %s\n", problem.c_str());
  }
  if (done.damaged > done.problems.size()) {
    std::printf("  and %zu more damaged scans\n", done.damaged - done.problems.size());
  }
  return 0;
}

}  // namespace

Action set_up_convert(CLI::App& command, const Globals& globals) {
  auto a = std::make_shared<ConvertArguments>();
  command.add_option("LOG", a->log, "drive log of any format")->required();
  command.add_option("-o,--output", a->output, "file or folder to make; must not exist")->required();
  command.add_option("--format", a->format, "of the output; else what its name says (.mcap, .bag)")
      ->check(CLI::IsMember(io::log_writer_formats()));
  command.add_option("--from", a->options.from_s, "seconds since the first scan");
  command.add_option("--to", a->options.to_s, "seconds since the first scan");
  command.add_option("--every", a->options.every, "only each so-manieth scan (default 1)");
  command.footer(kExamples);
  return [a, &globals] { return convert(*a, globals); };
}

}  // namespace loopmark::app
