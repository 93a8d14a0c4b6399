// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// loopmark describe: the descriptors of scans as files.

#include <cstdio>
#include <filesystem>
#include <memory>
#include <set>
#include <utility>

#include "commands.hpp"
#include "loopmark/core/error.hpp"
#include "loopmark/feature_registration/descriptor.hpp"
#include "loopmark/feature_registration/pipeline.hpp"
#include "loopmark/features/descriptor_export.hpp"
#include "loopmark/io/drive_log.hpp"
#include "loopmark/io/point_files.hpp"

namespace loopmark::app {
namespace {

constexpr const char* kExamples = R"(
Examples:
  loopmark describe a.pcd b.bin -o FEATURES                   FEATURES/a.npz and FEATURES/b.npz
  loopmark describe drives/day1 -o FEATURES/0                 every scan of a log: FEATURES/0/000000.npz, ...
  loopmark describe drives/day1 --descriptor fpfh -o FEATURES/0
Each file holds the keypoints as "xyz" (n, 3), metres in the sensor's frame, and their descriptors as "features" (n, d), for
numpy.load. loopmark register --descriptor FEATURES and loopmark evaluate --features NAME=FEATURES read them again.
)";

struct Arguments {
  std::vector<std::filesystem::path> inputs;
  std::string descriptor;
  std::filesystem::path output;
};

void describe_into(const PointCloud& cloud, const feature_registration::FeatureRegistrationOptions& options,
                   const std::filesystem::path& file) {
  const feature_registration::DescribedScan scan = feature_registration::describe_scan(cloud, options);
  features::export_descriptors(file, scan.keypoints, scan.descriptors);
}

/// One file for each scan: two scans of one name would overwrite each other.
class OutputFolder {
 public:
  explicit OutputFolder(std::filesystem::path folder) : folder_(std::move(folder)) {
    std::error_code error;
    std::filesystem::create_directories(folder_, error);
    if (error) {
      throw InputError(folder_.string(), "", "cannot make the folder: " + error.message());
    }
  }

  std::filesystem::path file_of(const std::string& scan) {
    if (!taken_.insert(scan).second) {
      throw InputError((folder_ / scan).string(), "", "two scans are called " + scan,
                       "describe them into folders of their own");
    }
    return folder_ / (scan + ".npz");
  }

  std::size_t size() const { return taken_.size(); }

 private:
  std::filesystem::path folder_;
  std::set<std::string> taken_;
};

void describe_log(const io::DriveLog& log, const feature_registration::FeatureRegistrationOptions& options,
                  OutputFolder& folder) {
  for (std::size_t i = 0; i < log.size(); ++i) {
    char name[32];
    std::snprintf(name, sizeof name, "%06zu", log.frame_number(i));
    describe_into(log.read(i).cloud, options, folder.file_of(name));
  }
}

bool is_point_file(const std::filesystem::path& path) {
  const std::string extension = path.extension().string();
  return std::filesystem::is_regular_file(path) && (extension == ".bin" || extension == ".pcd" || extension == ".ply");
}

int describe(const Arguments& a, const Globals& globals) {
  const workflows::ProgramOptions options = globals.options();
  feature_registration::FeatureRegistrationOptions paper = options.paper;
  paper.descriptor = a.descriptor.empty() ? paper.descriptor : a.descriptor;
  feature_registration::make_descriptor(paper);  // a wrong name is told before the folder is made
  OutputFolder folder(a.output);
  for (const std::filesystem::path& input : a.inputs) {
    if (is_point_file(input)) {
      describe_into(io::read_point_file(input).cloud, paper, folder.file_of(input.stem().string()));
    } else {
      describe_log(*io::open_log(input, options.log), paper, folder);
    }
  }
  std::printf("%zu scans described by %s in %s\n", folder.size(), paper.descriptor.c_str(), a.output.string().c_str());
  return 0;
}

}  // namespace

Action set_up_describe(CLI::App& command, const Globals& globals) {
  auto a = std::make_shared<Arguments>();
  command.add_option("inputs", a->inputs, "scans (.bin, .pcd, .ply), or a log")->required();
  command.add_option("--descriptor", a->descriptor, "fsc (the default) or fpfh; also paper.descriptor");
  command.add_option("-o,--output", a->output, "folder for one .npz a scan")->required();
  command.footer(kExamples);
  return [a, &globals] { return describe(*a, globals); };
}

}  // namespace loopmark::app
