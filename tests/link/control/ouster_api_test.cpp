// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#include <glidar/link/control/ouster_api.hpp>

#include "control_fixture.hpp"

#include <glidar/core/error.hpp>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

namespace glidar::control {
namespace {

using Json = nlohmann::json;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

struct Api {
  testing::Destinations destinations;
  OusterApi api{testing::ouster_options(destinations)};

  ApiReply get(const std::string& path) {
    return api.answer({"GET", "/api/v1/" + path, "", "127.0.0.1"});
  }
  ApiReply post(const std::string& body) {
    return api.answer({"POST", "/api/v1/sensor/config?reinit=true", body, "127.0.0.1"});
  }
  Json config() { return Json::parse(get("sensor/config").body); }
};

TEST(OusterApi, ServesTheMetadataAndTheirSections) {
  Api api;
  const Json all = Json::parse(api.get("sensor/metadata").body);
  EXPECT_EQ(all["lidar_data_format"]["columns_per_frame"], 1024);
  EXPECT_EQ(Json::parse(api.get("sensor/metadata/sensor_info").body), all["sensor_info"]);
  EXPECT_EQ(Json::parse(api.get("sensor/metadata/beam_intrinsics/").body), all["beam_intrinsics"]);
  EXPECT_EQ(Json::parse(api.get("sensor/config?staging=true").body), all["config_params"]);
  EXPECT_EQ(api.get("user/data").body, "\"\"");
  EXPECT_EQ(Json::parse(api.get("system/firmware").body)["fw"], all["sensor_info"]["image_rev"]);
  EXPECT_EQ(Json::parse(api.get("sensor/cmd/get_config_param?args=active").body),
            all["config_params"]);
  EXPECT_EQ(Json::parse(api.get("sensor/cmd/get_sensor_info").body), all["sensor_info"]);
  for (const char* path : {"", "sensor", "sensor/metadata/no", "sensor/cmd/no", "../etc/passwd"})
    EXPECT_EQ(api.get(path).status, 404) << path;
}

TEST(OusterApi, ClientsChooseTheDestinationOfPackets) {
  Api api;
  EXPECT_EQ(api.post(R"({"udp_dest":"@auto","udp_port_lidar":7600,"udp_port_imu":7601})").status,
            200);
  EXPECT_THAT(api.destinations.all(),
              ElementsAre("7502 to 127.0.0.1:7600", "7503 to 127.0.0.1:7601"));
  EXPECT_EQ(api.config()["udp_dest"], "127.0.0.1");
  EXPECT_EQ(Json::parse(api.get("sensor/metadata").body)["config_params"]["udp_port_lidar"], 7600);
  EXPECT_EQ(api.get("sensor/cmd/set_config_param?args=udp_ip+10.0.0.9").status, 200);
  EXPECT_EQ(api.get("sensor/cmd/set_config_param?args=.%20{%22udp_port_imu%22:99}").status, 200);
  EXPECT_EQ(api.get("sensor/cmd/set_udp_dest_auto").status, 200);
  EXPECT_EQ(api.config()["udp_dest"], "127.0.0.1");
  EXPECT_EQ(api.config()["udp_port_imu"], 99);
}

TEST(OusterApi, NobodyDirectsPacketsToOthers) {
  Api api;
  for (const char* value :
       {"\"10.0.0.8\"", "\"224.0.0.1\"", "\"255.255.255.255\"", "\"host\"", "1", "null", "[]"}) {
    const ApiReply reply = api.post("{\"udp_dest\":" + std::string(value) + "}");
    EXPECT_EQ(reply.status, 400) << value;
    EXPECT_THAT(reply.body, HasSubstr("udp_dest"));
  }
  EXPECT_THAT(api.destinations.all(), IsEmpty());
  EXPECT_EQ(api.config()["udp_dest"], "10.0.0.9");
}

TEST(OusterApi, AcceptsTheSimulatedConfigurationOnly) {
  Api api;
  const Json before = api.config();
  EXPECT_EQ(api.post(before.dump()).status, 200);
  for (const char* body :
       {R"({"lidar_mode":"2048x10"})", R"({"no_such_key":1})", R"({"udp_port_lidar":0})",
        R"({"udp_port_lidar":65536})", R"({"udp_port_lidar":"7502"})", R"({"udp_port_lidar":-1})",
        R"({"udp_port_lidar":7600,"lidar_mode":"512x10"})", "[]", "1", "{", "\xff",
        "{\"a\":[[[[[[[[[[]]]]]]]]]]}"}) {
    const ApiReply reply = api.post(body);
    EXPECT_EQ(reply.status, 400) << body;
    EXPECT_TRUE(Json::parse(reply.body).contains("error")) << body;
  }
  EXPECT_EQ(api.config(), before);
  EXPECT_THAT(api.destinations.all(), IsEmpty());
}

TEST(OusterApi, RequestsThatMayOnlyReadChangeNothing) {
  Api api;
  const link::HttpRefusal reason{403, "read only"};
  for (const char* target :
       {"sensor/cmd/set_udp_dest_auto", "sensor/cmd/set_config_param?args=udp_port_lidar%207600"}) {
    const std::string whole = "/api/v1/" + std::string(target);
    const ApiReply reply = api.api.answer({"GET", whole, "", "127.0.0.1", reason});
    EXPECT_EQ(reply.status, 403) << target;
    EXPECT_THAT(reply.body, HasSubstr("read only"));
  }
  EXPECT_EQ(api.api.answer({"POST", "/api/v1/sensor/config", "{}", "127.0.0.1", reason}).status,
            403);
  EXPECT_EQ(api.api.answer({"GET", "/api/v1/sensor/config", "", "127.0.0.1", reason}).status, 200);
  EXPECT_THAT(api.destinations.all(), IsEmpty());
}

TEST(OusterApi, OtherMethodsAreRefused) {
  Api api;
  EXPECT_EQ(api.api.answer({"DELETE", "/api/v1/sensor/config"}).status, 405);
  EXPECT_EQ(api.api.answer({"POST", "/api/v1/sensor/metadata"}).status, 404);
  EXPECT_EQ(api.api.answer({"GET", "/"}).status, 404);
  EXPECT_THROW(OusterApi({.metadata = "{}"}), Error);
}

}  // namespace
}  // namespace glidar::control
