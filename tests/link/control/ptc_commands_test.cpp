// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/link/control/control_server.hpp>

#include "control_fixture.hpp"

#include <gmock/gmock.h>

#include <sstream>

namespace glidar::control {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using testing::ptc_request;

struct Ptc {
  explicit Ptc(const std::string& preset = "XT32")
      : commands(testing::ptc_sensor(destinations, preset)),
        conversation(make_ptc_conversation(commands, "127.0.0.1")) {}

  /// The payload of an answer of success; "refused N" otherwise.
  std::string ask(int command, const std::string& payload = {}) {
    const std::string request = ptc_request(command, payload);
    const Step step = conversation->receive(request);
    EXPECT_EQ(step.consumed, request.size());
    EXPECT_FALSE(step.ends);
    EXPECT_EQ(step.answer.substr(0, 3), request.substr(0, 3));
    if (step.answer[3] != 0) return "refused " + std::to_string(step.answer[3]);
    return step.answer.substr(8);
  }

  testing::Destinations destinations;
  PtcCommands commands;
  std::unique_ptr<Conversation> conversation;
};

TEST(PtcCommands, CalibrationHasTheAnglesOfEveryChannel) {
  for (const char* preset : {"Pandar64", "QT64", "XT32"}) {
    Ptc ptc(preset);
    const Sensor sensor = testing::packet_sensor(preset, false);
    const auto& channels = std::get<Spinning>(sensor.optics).channels;
    std::istringstream text(ptc.ask(0x05));
    std::string line;
    std::getline(text, line);
    EXPECT_EQ(line, "Channel,Elevation,Azimuth");
    for (std::size_t i = 0; i < channels.size(); ++i) {
      std::size_t number = 0;
      double elevation_deg = 0.0;
      double azimuth_deg = 0.0;
      char comma = 0;
      text >> number >> comma >> elevation_deg >> comma >> azimuth_deg;
      EXPECT_EQ(number, i + 1);
      EXPECT_NEAR(elevation_deg * kDegree, channels[i].elevation_rad, 0.0001 * kDegree);
      EXPECT_NEAR(-azimuth_deg * kDegree, channels[i].azimuth_offset_rad, 0.0001 * kDegree);
    }
    EXPECT_FALSE(text >> line);
  }
}

TEST(PtcCommands, InformationHasTheSizesThatDriversExpect) {
  Ptc ptc;
  const std::string inventory = ptc.ask(0x07);
  EXPECT_EQ(inventory.size(), 120U);
  EXPECT_EQ(inventory.substr(106, 3), std::string("\x19\0\x20", 3));  // PandarXT-32
  const std::string config = ptc.ask(0x08);
  EXPECT_EQ(config.size(), 47U);
  EXPECT_EQ(config.substr(12, 10), std::string("\x0a\0\0\x09\x09\x40\x27\x7e\x02\x58", 10));
  EXPECT_EQ(ptc.ask(0x09).size(), 54U);
  EXPECT_EQ(ptc.ask(0x23), std::string("\0\0\0\x0e\x10", 5));
}

TEST(PtcCommands, ClientsChooseTheDestinationOfPacketsButNotOthers) {
  Ptc ptc;
  EXPECT_EQ(ptc.ask(0x20, std::string("\x7f\0\0\x01\x0f\xa0\0\0", 8)), "");
  EXPECT_EQ(ptc.ask(0x20, std::string("\x0a\0\0\x09\x0f\xa1\0\0", 8)), "");
  EXPECT_THAT(ptc.destinations.all(),
              ElementsAre("2368 to 127.0.0.1:4000", "2368 to 10.0.0.9:4001"));
  EXPECT_EQ(ptc.ask(0x08).substr(12, 6), std::string("\x0a\0\0\x09\x0f\xa1", 6));
  EXPECT_EQ(ptc.ask(0x20, std::string("\x0a\0\0\x08\x0f\xa0\0\0", 8)), "refused 1");
  EXPECT_EQ(ptc.ask(0x20, std::string("\x7f\0\0\x01\0\0\0\0", 8)), "refused 1");
  EXPECT_EQ(ptc.ask(0x20, "short"), "refused 3");
  EXPECT_EQ(ptc.destinations.all().size(), 2U);
}

TEST(PtcCommands, AcceptTheSimulatedConfigurationOnly) {
  Ptc ptc;
  EXPECT_EQ(ptc.ask(0x17, "\x02\x58"), "");
  EXPECT_EQ(ptc.ask(0x17, "\x04\xb0"), "refused 1");
  EXPECT_EQ(ptc.ask(0x17), "refused 1");
  EXPECT_EQ(ptc.ask(0x1e, "\x01"), "");
  EXPECT_EQ(ptc.ask(0x1e, "\x02"), "refused 1");
  EXPECT_EQ(ptc.ask(0x22, std::string("\0\0\0\x0e\x10", 5)), "");
  EXPECT_EQ(ptc.ask(0x22, std::string("\0\0\0\x00\x10", 5)), "refused 1");
  EXPECT_EQ(ptc.ask(0xa9), "refused 5");
  EXPECT_THAT(ptc.destinations.all(), IsEmpty());
}

TEST(PtcConversation, WaitsForTheWholeRequestAndAnswersSeveral) {
  Ptc ptc;
  const std::string request = ptc_request(0x17, "\x02\x58");
  for (std::size_t size = 0; size < request.size(); ++size) {
    const Step step = ptc.conversation->receive(request.substr(0, size));
    EXPECT_EQ(step.answer, "");
    EXPECT_FALSE(step.ends);
  }
  const Step step = ptc.conversation->receive(request + ptc_request(0x05));
  EXPECT_EQ(step.consumed, request.size());
}

TEST(PtcConversation, EndsWithWhatIsNoRequest) {
  for (const std::string& bytes : {std::string("GET / HTTP/1.1\r\n"), std::string("\x47\x75"),
                                   std::string("\x47\x74\x05\0\0\0\x04\x01", 8),
                                   std::string("\x47\x74\x05\0\xff\xff\xff\xff", 8)}) {
    Ptc ptc;
    const Step step = ptc.conversation->receive(bytes);
    EXPECT_TRUE(step.ends);
    EXPECT_EQ(step.consumed, bytes.size());
    EXPECT_NE(step.error, "");
  }
}

}  // namespace
}  // namespace glidar::control
