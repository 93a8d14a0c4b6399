// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>

#include "loopmark/recordings/recording.hpp"

namespace loopmark::messages {

/// What is wrong with the definition that a file gives for one of the messages of types.hpp: other fields, or in
/// another order, than are decoded. Empty when they agree, the file gives none, or the type is not known here.
std::string definition_problem(const recordings::Channel& channel);

/// The definition of a type in ROS's language with everything that it is made of, as MCAP files and ROS 1 bags hold it.
/// `ros1`: with the header's sequence number and ROS 1's time. Throws std::out_of_range for a type not known here.
std::string definition_text(const std::string& type, bool ros1);

/// The MD5 sum by which ROS 1 tells a type. Throws std::out_of_range for a type not known here.
std::string definition_md5(const std::string& type);

}  // namespace loopmark::messages
