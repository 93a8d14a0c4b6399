// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/messages/definitions.hpp"

#include <map>
#include <set>
#include <sstream>
#include <vector>

namespace loopmark::messages {
namespace {

/// The fields of each type as the packages of ROS define them, and ROS 1's MD5 sum of it where bags of it are written.
struct Definition {
  const char* fields;
  const char* md5 = "";
};

const std::map<std::string, Definition>& definitions() {
  static const std::map<std::string, Definition> table = {
      {"std_msgs/Header", {"uint32 seq\ntime stamp\nstring frame_id\n"}},
      {"sensor_msgs/PointField",
       {"uint8 INT8=1\nuint8 UINT8=2\nuint8 INT16=3\nuint8 UINT16=4\nuint8 INT32=5\nuint8 UINT32=6\nuint8 FLOAT32=7\n"
        "uint8 FLOAT64=8\nstring name\nuint32 offset\nuint8 datatype\nuint32 count\n"}},
      {"sensor_msgs/PointCloud2",
       {"std_msgs/Header header\nuint32 height\nuint32 width\nsensor_msgs/PointField[] fields\nbool is_bigendian\n"
        "uint32 point_step\nuint32 row_step\nuint8[] data\nbool is_dense\n",
        "1158d486dd51d683ce2f1be655c3c181"}},
      {"geometry_msgs/Vector3", {"float64 x\nfloat64 y\nfloat64 z\n"}},
      {"geometry_msgs/Point", {"float64 x\nfloat64 y\nfloat64 z\n"}},
      {"geometry_msgs/Quaternion", {"float64 x\nfloat64 y\nfloat64 z\nfloat64 w\n"}},
      {"geometry_msgs/Pose", {"geometry_msgs/Point position\ngeometry_msgs/Quaternion orientation\n"}},
      {"geometry_msgs/PoseWithCovariance", {"geometry_msgs/Pose pose\nfloat64[36] covariance\n"}},
      {"geometry_msgs/Twist", {"geometry_msgs/Vector3 linear\ngeometry_msgs/Vector3 angular\n"}},
      {"geometry_msgs/TwistWithCovariance", {"geometry_msgs/Twist twist\nfloat64[36] covariance\n"}},
      {"geometry_msgs/Transform", {"geometry_msgs/Vector3 translation\ngeometry_msgs/Quaternion rotation\n"}},
      {"geometry_msgs/TransformStamped",
       {"std_msgs/Header header\nstring child_frame_id\ngeometry_msgs/Transform transform\n"}},
      {"geometry_msgs/PoseStamped",
       {"std_msgs/Header header\ngeometry_msgs/Pose pose\n", "d3812c3cbc69362b77dc0b19b345f8f5"}},
      {"sensor_msgs/Imu",
       {"std_msgs/Header header\ngeometry_msgs/Quaternion orientation\nfloat64[9] orientation_covariance\n"
        "geometry_msgs/Vector3 angular_velocity\nfloat64[9] angular_velocity_covariance\n"
        "geometry_msgs/Vector3 linear_acceleration\nfloat64[9] linear_acceleration_covariance\n",
        "6a62c6daae103f4ff57a132d6f95cec2"}},
      {"sensor_msgs/NavSatStatus",
       {"int8 STATUS_NO_FIX=-1\nint8 STATUS_FIX=0\nint8 STATUS_SBAS_FIX=1\nint8 STATUS_GBAS_FIX=2\nint8 status\n"
        "uint16 SERVICE_GPS=1\nuint16 SERVICE_GLONASS=2\nuint16 SERVICE_COMPASS=4\nuint16 SERVICE_GALILEO=8\n"
        "uint16 service\n"}},
      {"sensor_msgs/NavSatFix",
       {"std_msgs/Header header\nsensor_msgs/NavSatStatus status\nfloat64 latitude\nfloat64 longitude\n"
        "float64 altitude\nfloat64[9] position_covariance\nuint8 COVARIANCE_TYPE_UNKNOWN=0\n"
        "uint8 COVARIANCE_TYPE_APPROXIMATED=1\nuint8 COVARIANCE_TYPE_DIAGONAL_KNOWN=2\n"
        "uint8 COVARIANCE_TYPE_KNOWN=3\nuint8 position_covariance_type\n",
        "2d3a8cd499b9b4a0249fb98fd05cfa48"}},
      {"nav_msgs/Odometry",
       {"std_msgs/Header header\nstring child_frame_id\ngeometry_msgs/PoseWithCovariance pose\n"
        "geometry_msgs/TwistWithCovariance twist\n",
        "cd5e73d190d741a2f92e81eda573aca7"}},
      {"nav_msgs/Path",
       {"std_msgs/Header header\ngeometry_msgs/PoseStamped[] poses\n", "6227e2b7e9cce15051f669a5e197bbf7"}},
      {"tf2_msgs/TFMessage", {"geometry_msgs/TransformStamped[] transforms\n", "94810edda583a504dfda3829e70d7eec"}},
      {"velodyne_msgs/VelodynePacket", {"time stamp\nuint8[1206] data\n"}},
      {"velodyne_msgs/VelodyneScan", {"std_msgs/Header header\nvelodyne_msgs/VelodynePacket[] packets\n"}},
      {"pandar_msgs/PandarPacket", {"time stamp\nuint8[1500] data\nuint32 size\n"}},
      {"pandar_msgs/PandarScan", {"std_msgs/Header header\npandar_msgs/PandarPacket[] packets\n"}},
      {"livox_ros_driver/CustomPoint",
       {"uint32 offset_time\nfloat32 x\nfloat32 y\nfloat32 z\nuint8 reflectivity\nuint8 tag\nuint8 line\n"}},
      {"livox_ros_driver/CustomMsg",
       {"std_msgs/Header header\nuint64 timebase\nuint32 point_num\nuint8 lidar_id\nuint8[3] rsvd\n"
        "livox_ros_driver/CustomPoint[] points\n"}},
  };
  return table;
}

std::string base_type(std::string_view type) { return std::string(type.substr(0, type.find('['))); }

/// "type name" of each field: constants and comments left out, types without their package.
std::vector<std::string> fields_of(const std::string& text) {
  std::vector<std::string> fields;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    line.resize(std::min(line.find('#'), line.size()));
    std::istringstream words(line);
    std::string type, name;
    if (!(words >> type >> name) || line.find('=') != std::string::npos) {
      continue;
    }
    type = type.substr(type.rfind('/') == std::string::npos ? 0 : type.rfind('/') + 1);
    type = type == "Time" ? "time" : type == "byte" || type == "char" ? "uint8" : type;
    if (name != "seq" || type != "uint32") {  // the header of ROS 2 has none
      fields.push_back(type + " " + name);
    }
  }
  return fields;
}

/// The parts of a definition with everything that it is made of: its own first, then those called "MSG: package/Type".
std::vector<std::pair<std::string, std::string>> parts_of(const std::string& type, const std::string& definition) {
  std::vector<std::pair<std::string, std::string>> parts{{type, ""}};
  std::istringstream lines(definition);
  for (std::string line; std::getline(lines, line);) {
    if (line.rfind("MSG: ", 0) == 0) {
      parts.emplace_back(recordings::plain_type(line.substr(5)), "");
    } else if (line.rfind("====", 0) != 0) {
      parts.back().second += line + "\n";
    }
  }
  return parts;
}

/// livox_ros_driver2 and hesai's names for the same messages.
std::string known_name(std::string type) {
  const auto rename = [&type](std::string_view from, std::string_view to) {
    if (type.rfind(from, 0) == 0) {
      type = std::string(to) + type.substr(from.size());
    }
  };
  rename("livox_ros_driver2/", "livox_ros_driver/");
  rename("livox_interfaces/", "livox_ros_driver/");
  rename("hesai_lidar/", "pandar_msgs/");
  return type;
}

void add_parts(const std::string& type, bool ros1, std::set<std::string>& done, std::string& text) {
  if (!done.insert(type).second) {
    return;
  }
  std::istringstream lines(definitions().at(type).fields);
  std::vector<std::string> inner;
  if (done.size() > 1) {
    text += std::string(80, '=') + "\nMSG: " + type + "\n";
  }
  for (std::string line; std::getline(lines, line);) {
    const std::string first = base_type(line.substr(0, line.find(' ')));
    if (!ros1 && line == "uint32 seq") {
      continue;
    }
    if (!ros1 && first == "time") {
      line = "builtin_interfaces/Time" + line.substr(4);
      inner.emplace_back("builtin_interfaces/Time");
    }
    text += line + "\n";
    if (definitions().contains(first)) {
      inner.push_back(first);
    }
  }
  for (const std::string& next : inner) {
    if (next != "builtin_interfaces/Time") {
      add_parts(next, ros1, done, text);
    } else if (done.insert(next).second) {
      text += std::string(80, '=') + "\nMSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec\n";
    }
  }
}

}  // namespace

std::string definition_problem(const recordings::Channel& channel) {
  if (channel.definition.empty()) {
    return "";
  }
  for (const auto& [type, text] : parts_of(channel.type, channel.definition)) {
    const auto known = definitions().find(known_name(type));
    if (known != definitions().end() && !text.empty() && fields_of(text) != fields_of(known->second.fields)) {
      return "the recording defines " + type + " otherwise than it is known here";
    }
  }
  return "";
}

std::string definition_text(const std::string& type, bool ros1) {
  std::string text;
  std::set<std::string> done;
  add_parts(type, ros1, done, text);
  return text;
}

std::string definition_md5(const std::string& type) { return definitions().at(type).md5; }

}  // namespace loopmark::messages
