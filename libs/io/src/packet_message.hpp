// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// Messages that hold the packets of one sweep, as the drivers of spinning sensors record them.
#pragma once

#include "calibration_file.hpp"
#include "cloud_message.hpp"
#include "loopmark/messages/types.hpp"
#include "loopmark/packets/packet_decoder.hpp"
#include "point_columns.hpp"

namespace loopmark::io::internal {

/// The cloud of a finished sweep.
PointFile finish_sweep(packets::SweepCloud sweep, const LogOptions& options);

/// Message: messages::VelodyneScan or PandarScan.
template <class Message>
class PacketMessageDecoder : public CloudDecoder {
 public:
  PacketMessageDecoder(const MessageSamples& samples, const LogOptions& options, const char* calibration_extension)
      : encoding_(samples.channel.encoding), options_(options) {
    const auto calibration = find_calibration(samples.file, calibration_extension);
    for (const std::string& bytes : samples.messages) {
      const auto m = messages::decode<Message>(encoding_, bytes);
      frame_id_ = m.header.frame_id;
      for (const auto& packet : m.packets) {
        decoder_ = decoder_ ? std::move(decoder_) : packets::make_decoder(content_of(packet), calibration);
      }
    }
    if (!decoder_) {
      throw InputError(samples.file.string(), "topic " + samples.channel.topic, "packets of no sensor that is known");
    }
  }

  PointFile decode(std::string_view message) const override {
    const auto m = messages::decode<Message>(encoding_, message);
    packets::SweepCloud sweep;
    for (const auto& packet : m.packets) {
      const packets::Packet p{std::int64_t{packet.seconds} * 1'000'000'000 + packet.nanoseconds, content_of(packet)};
      if (decoder_->accepts(p.bytes)) {
        decoder_->decode(p, 0, decoder_->blocks(p.bytes), sweep);
      }
    }
    return finish_sweep(std::move(sweep), options_);
  }

  std::string describe() const override {
    return "packets of a " + decoder_->sensor() + ", with the time of each point";
  }
  std::string frame_id() const override { return frame_id_; }

 private:
  template <class P>
  static std::string_view content_of(const P& packet) {
    return packet.data.substr(0, packet.size);
  }

  messages::Encoding encoding_;
  LogOptions options_;
  std::unique_ptr<packets::PacketDecoder> decoder_;
  std::string frame_id_;
};

}  // namespace loopmark::io::internal
