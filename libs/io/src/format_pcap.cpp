// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
// Packet captures: the datagrams of one sensor, cut into sweeps where the sensor begins a new one.
#include <algorithm>
#include <map>

#include "calibration_file.hpp"
#include "file_log.hpp"
#include "layouts.hpp"
#include "loopmark/core/interrupt.hpp"
#include "loopmark/core/progress.hpp"
#include "loopmark/io/log_formats.hpp"
#include "loopmark/io/recorded_log.hpp"
#include "loopmark/packets/packet_decoder.hpp"
#include "loopmark/recordings/packet_capture.hpp"
#include "packet_message.hpp"
#include "point_times.hpp"
#include "recording_log.hpp"

namespace loopmark::io::internal {
namespace {

namespace fs = std::filesystem;
using recordings::Datagram;

/// Where a sweep begins: its first packet and the block in it.
struct SweepPlace {
  std::uint64_t place = 0;
  std::size_t block = 0;
  std::int64_t time_ns = 0;
  std::size_t packets = 0;
};

/// What one sensor sends to one port.
struct PacketStream {
  std::unique_ptr<packets::PacketDecoder> decoder;  ///< none: packets of no sensor that is known
  std::string problem;                              ///< why they cannot be decoded although their sensor is known
  packets::CutState cut;
  std::vector<SweepPlace> sweeps;
  TopicFacts facts;
};

/// Finds out what sends to a port by its first packet.
void meet_stream(PacketStream& stream, const recordings::Datagram& datagram, const fs::path& file) {
  stream.facts.topic = datagram.stream();
  stream.facts.type = "packets of " + std::to_string(datagram.bytes.size()) + " bytes";
  try {
    const bool hesai = datagram.bytes.substr(0, 2) == "\xee\xff" || datagram.bytes.size() > 1206;
    stream.decoder = packets::make_decoder(datagram.bytes, find_calibration(file, hesai ? ".csv" : ".yaml"));
    const fs::path metadata = stream.decoder ? fs::path() : find_calibration(file, ".json");
    if (!stream.decoder && !metadata.empty()) {
      stream.decoder = packets::make_ouster_decoder(metadata);
      if (!stream.decoder->accepts(datagram.bytes)) {
        stream.problem = packets::looks_like_ouster(datagram.bytes)
                             ? "packets of " + std::to_string(datagram.bytes.size()) +
                                   " bytes do not fit the sensor that " + metadata.string() + " describes"
                             : "";
        stream.decoder = nullptr;
      }
    } else if (!stream.decoder && packets::looks_like_ouster(datagram.bytes)) {
      stream.problem =
          "packets of an Ouster sensor, which only its metadata file explains "
          "(put the sensor's .json beside the capture)";
    }
  } catch (const InputError& error) {
    stream.problem = error.what();
  }
  stream.facts.has_scans = stream.decoder != nullptr;
  stream.facts.problem = stream.problem;
  stream.facts.type = stream.decoder ? stream.decoder->sensor() : stream.facts.type;
}

void take_packet(PacketStream& stream, const recordings::Datagram& datagram) {
  TopicFacts& facts = stream.facts;
  facts.first_s = facts.messages == 0 ? 1e-9 * static_cast<double>(datagram.time_ns) : facts.first_s;
  facts.last_s = 1e-9 * static_cast<double>(datagram.time_ns);
  ++facts.messages;
  facts.bytes += datagram.bytes.size();
  if (!stream.decoder || !stream.decoder->accepts(datagram.bytes)) {
    return;
  }
  const std::optional<std::size_t> cut = stream.decoder->cut(datagram.bytes, stream.cut);
  if (stream.sweeps.empty() || cut) {
    stream.sweeps.push_back({datagram.place, cut.value_or(0), datagram.time_ns, 0});
  }
  ++stream.sweeps.back().packets;
}

class CaptureLog : public RecordedLog {
 public:
  CaptureLog(const fs::path& file, const LogOptions& options) : capture_(file), options_(options) {
    info_.path = file;
    info_.format = "pcap";
    std::map<std::string, PacketStream> streams = find_streams();
    choose(streams);
    drop_partial_sweeps();
    for (const SweepPlace& sweep : sweeps_) {
      stamps_s_.push_back(1e-9 * static_cast<double>(sweep.time_ns));
    }
    info_.stamps_given = true;
    info_.stamps_source = "the capture, of each sweep's first packet";
    facts_.topic_content = "packets of a " + decoder_->sensor() + ", with the time of each point";
  }

  std::size_t size() const override { return sweeps_.size() - (ends_at_last_ ? 1 : 0); }
  double stamp_s(std::size_t index) const override { return stamps_s_.at(index); }
  std::string scan_name(std::size_t index) const override {
    return info_.path.string() + ":byte " + std::to_string(sweeps_.at(index).place);
  }
  fs::path scan_file(std::size_t) const override { return info_.path; }
  Scan read(std::size_t index) const override { return read_closely(index).scan; }
  const LogInfo& info() const override { return info_; }
  const RecordingFacts& recording() const override { return facts_; }
  std::vector<Pose> truth() const override { return {}; }

  ScanReading read_closely(std::size_t index) const override {
    const SweepPlace& begin = sweeps_.at(index);
    const SweepPlace* end = index + 1 < sweeps_.size() ? &sweeps_[index + 1] : nullptr;
    packets::SweepCloud sweep;
    capture_.walk(begin.place, [&](const recordings::Datagram& datagram) {
      if (datagram.stream() != facts_.topic || !decoder_->accepts(datagram.bytes)) {
        return true;
      }
      const bool last = end != nullptr && datagram.place >= end->place;
      decoder_->decode({datagram.time_ns, datagram.bytes}, datagram.place == begin.place ? begin.block : 0,
                       last ? end->block : decoder_->blocks(datagram.bytes), sweep);
      return !last;
    });
    PointFile file = finish_sweep(std::move(sweep), options_);
    ScanReading reading{{index, stamp_s(index), std::move(file.cloud)}, file.dropped, false, false};
    finish_reading(reading, scan_name(index), info_, options_);
    return reading;
  }

  void visit_observations(const ObservationVisitor& visit) const override {
    capture_.walk(0, [&](const recordings::Datagram& datagram) {
      if (const auto imu = packets::read_ouster_imu(datagram.bytes)) {
        visit(ImuSample{{1e-9 * static_cast<double>(datagram.time_ns), datagram.stream(), "os_imu"},
                        imu->angular_velocity_rad_s,
                        imu->acceleration_m_s2,
                        std::nullopt});
      }
      return true;
    });
  }

 private:
  std::map<std::string, PacketStream> find_streams() {
    constexpr std::size_t kMostStreams = 256;
    std::map<std::string, PacketStream> streams;
    Progress progress("packets", 0);
    std::size_t seen = 0;
    info_.problem = capture_.walk(0, [&](const recordings::Datagram& datagram) {
      if (++seen % 1024 == 0) {
        check_interrupt();
        progress.add(1024);
      }
      const std::string name = datagram.stream();
      auto found = streams.find(name);
      if (found == streams.end()) {
        if (streams.size() >= kMostStreams) {
          return true;
        }
        found = streams.try_emplace(name).first;
        meet_stream(found->second, datagram, info_.path);
      }
      take_packet(found->second, datagram);
      return true;
    });
    if (!info_.problem.empty()) {
      log(Severity::kWarning, info_.problem);
    }
    return streams;
  }

  void choose(std::map<std::string, PacketStream>& streams) {
    PacketStream* best = nullptr;
    std::string problem = streams.empty() ? "no UDP packets" : "no packets of a sensor that is known";
    std::size_t sensors = 0;
    for (auto& [name, stream] : streams) {
      facts_.topics.push_back(stream.facts);
      sensors += stream.sweeps.empty() ? 0 : 1;
      problem = stream.problem.empty() ? problem : name + ": " + stream.problem;
      const bool wanted = options_.sensor_label.empty() || options_.sensor_label == name;
      if (wanted && !stream.sweeps.empty() && (best == nullptr || stream.facts.bytes > best->facts.bytes)) {
        best = &stream;
      }
    }
    if (best == nullptr) {
      throw InputError(info_.path.string(), options_.sensor_label.empty() ? "" : "stream " + options_.sensor_label,
                       problem,
                       "Velodyne, Hesai and Ouster sensors are known; loopmark doctor lists what a capture holds");
    }
    facts_.topic = best->facts.topic;
    facts_.topic_reason =
        sensors == 1 ? "the only sensor"
                     : "of " + std::to_string(sensors) + " sensors the one that sends most; --topic chooses another";
    decoder_ = std::move(best->decoder);
    sweeps_ = std::move(best->sweeps);
  }

  /// A capture begins and ends somewhere in a sweep; sweeps with less than four fifths of the usual packets are left
  /// out at either end.
  void drop_partial_sweeps() {
    std::vector<std::size_t> packets;
    for (const SweepPlace& sweep : sweeps_) {
      packets.push_back(sweep.packets);
    }
    std::nth_element(packets.begin(), packets.begin() + static_cast<std::ptrdiff_t>(packets.size() / 2), packets.end());
    const std::size_t usual = packets[packets.size() / 2];
    if (sweeps_.size() > 2 && 5 * sweeps_.front().packets < 4 * usual) {
      sweeps_.erase(sweeps_.begin());
    }
    ends_at_last_ = sweeps_.size() > 1 && 5 * sweeps_.back().packets < 4 * usual;
  }

  recordings::PacketCapture capture_;
  LogOptions options_;
  LogInfo info_;
  RecordingFacts facts_;
  std::unique_ptr<packets::PacketDecoder> decoder_;
  std::vector<SweepPlace> sweeps_;
  std::vector<double> stamps_s_;
  bool ends_at_last_ = false;  ///< the last sweep is partial: it only says where the one before ends
};

}  // namespace

DriveLogFormat format_pcap() {
  return {"pcap", "packet capture of a Velodyne, Ouster or Hesai sensor: a .pcap or .pcapng file", 20,
          [](const fs::path& path, const LogOptions& options) -> LogPointer {
            const fs::path file = only_recording(path, recordings::is_packet_capture);
            return file.empty() ? nullptr : std::make_unique<CaptureLog>(file, options);
          }};
}

}  // namespace loopmark::io::internal
