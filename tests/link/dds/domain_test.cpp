// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/link/dds/domain.hpp>

#include <glidar/core/error.hpp>

#include <gmock/gmock.h>

#include <cstdlib>
#include <optional>
#include <string>

namespace glidar::dds {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

/// Sets a variable for a test.
class Variable {
 public:
  Variable(const char* name, const char* value) : name_(name) {
    if (const char* before = std::getenv(name)) before_ = before;
    setenv(name, value, 1);
  }
  ~Variable() { before_ ? setenv(name_, before_->c_str(), 1) : unsetenv(name_); }
  Variable(const Variable&) = delete;
  Variable& operator=(const Variable&) = delete;

 private:
  const char* name_;
  std::optional<std::string> before_;
};

TEST(DdsDomain, IsThatOfTheEnvironment) {
  const Variable empty("ROS_DOMAIN_ID", "");
  EXPECT_EQ(domain_id({}), 0U);
  const Variable set("ROS_DOMAIN_ID", "42");
  EXPECT_EQ(domain_id({}), 42U);
  EXPECT_EQ(domain_id({.id = 7}), 7U);
}

TEST(DdsDomain, RefusesNumbersThatRosRefuses) {
  for (const char* text : {"-1", "233", "1.5", " 1", "1 ", "x", "99999999999999999999"}) {
    const Variable variable("ROS_DOMAIN_ID", text);
    EXPECT_THROW(domain_id({}), Error) << text;
  }
  EXPECT_EQ(domain_id({.id = 232}), 232U);
  EXPECT_THROW(domain_id({.id = 233}), Error);
}

TEST(DdsDomain, StaysOnThisMachineByDefault) {
  const Variable ignored("CYCLONEDDS_URI", "<CycloneDDS/>");
  const std::string config = domain_config({.id = 1});
  EXPECT_THAT(config, HasSubstr(R"(<NetworkInterface name="lo" multicast="true"/>)"));
  EXPECT_THAT(config, HasSubstr(R"(<SocketReceiveBufferSize max="10000000 B"/>)"));
  EXPECT_THAT(config, HasSubstr("<MaxAutoParticipantIndex>119<"));
  EXPECT_THAT(config, HasSubstr("<MulticastTimeToLive>0<"));
  EXPECT_THAT(config, Not(HasSubstr(",")));
  EXPECT_THAT(domain_config({.id = 232}), HasSubstr("<MaxAutoParticipantIndex>62<"));
}

TEST(DdsDomain, LetsCycloneDdsChooseTheInterfaceOnRequest) {
  const Variable variable("CYCLONEDDS_URI", "<CycloneDDS/>");
  const std::string config = domain_config({.id = 1, .interface_name = kAnyInterface});
  EXPECT_THAT(config, Not(HasSubstr("NetworkInterface")));
  EXPECT_THAT(config, ::testing::EndsWith(",<CycloneDDS/>"));
}

TEST(DdsDomain, RefusesUnknownInterfacesAndListsThoseThatExist) {
  for (const char* name : {"", "nosuch0", R"(lo"/>)", "lo lo"}) {
    try {
      domain_config({.id = 1, .interface_name = name});
      ADD_FAILURE() << name;
    } catch (const Error& error) {
      EXPECT_THAT(error.what(), HasSubstr("auto, lo"));
    }
  }
}

TEST(DdsDomain, AdvisesToRaiseASmallLimitOfSocketBuffers) {
  EXPECT_EQ(socket_buffer_advice(kSocketBuffer_bytes), "");
  EXPECT_THAT(socket_buffer_advice(212'992), HasSubstr("net.core.rmem_max=10000000"));
}

}  // namespace
}  // namespace glidar::dds
