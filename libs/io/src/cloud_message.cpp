// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "cloud_message.hpp"

#include <algorithm>

namespace loopmark::io::internal {

std::vector<CloudMessage> all_cloud_messages();  // made by the build

namespace {

/// Drivers that renamed a package, not its messages.
std::string usual_name(const std::string& type) {
  if (type == "livox_ros_driver2/CustomMsg" || type == "livox_interfaces/CustomMsg") {
    return "livox_ros_driver/CustomMsg";
  }
  return type == "hesai_lidar/PandarScan" ? "pandar_msgs/PandarScan" : type;
}

}  // namespace

const std::vector<CloudMessage>& cloud_messages() {
  static const std::vector<CloudMessage> table = all_cloud_messages();
  return table;
}

const CloudMessage* find_cloud_message(const std::string& type) {
  const auto& all = cloud_messages();
  const auto found =
      std::find_if(all.begin(), all.end(), [&](const CloudMessage& m) { return m.type == usual_name(type); });
  return found == all.end() ? nullptr : &*found;
}

}  // namespace loopmark::io::internal
