// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
// Reads a topic with Fast DDS, as nodes of ROS 2 with rmw_fastrtps do, and prints the bytes of
// every message in hexadecimal: fastdds_reader TOPIC TYPE COUNT. Prints "matched" before.
#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/DataReaderListener.hpp>
#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>
#include <fastdds/dds/topic/Topic.hpp>
#include <fastdds/dds/topic/TopicDataType.hpp>

#if __has_include(<fastdds/rtps/transport/UDPv4TransportDescriptor.hpp>)
#define FASTDDS_VERSION 3
#include <fastdds/rtps/transport/UDPv4TransportDescriptor.hpp>
#else
#define FASTDDS_VERSION 2
#include <fastdds/rtps/transport/UDPv4TransportDescriptor.h>
#endif

#include <condition_variable>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

namespace {

using namespace eprosima::fastdds::dds;  // NOLINT(google-build-using-namespace)

using Bytes = std::vector<unsigned char>;
constexpr std::uint32_t kMax_bytes = 16'000'000;

/// Messages as they come.
#if FASTDDS_VERSION == 3
namespace rtps = eprosima::fastdds::rtps;
constexpr auto kOk = RETCODE_OK;

class SerializedType : public TopicDataType {
 public:
  explicit SerializedType(const std::string& name) {
    set_name(name);
    max_serialized_type_size = kMax_bytes;
  }
  bool serialize(const void* /*data*/, rtps::SerializedPayload_t& /*payload*/,
                 DataRepresentationId_t /*kind*/) override {
    return false;
  }
  bool deserialize(rtps::SerializedPayload_t& payload, void* data) override {
    static_cast<Bytes*>(data)->assign(payload.data, payload.data + payload.length);
    return true;
  }
  std::uint32_t calculate_serialized_size(const void* /*data*/,
                                          DataRepresentationId_t /*kind*/) override {
    return 0;
  }
  void* create_data() override { return new Bytes; }
  void delete_data(void* data) override { delete static_cast<Bytes*>(data); }
  bool compute_key(rtps::SerializedPayload_t& /*payload*/, rtps::InstanceHandle_t& /*handle*/,
                   bool /*force_md5*/) override {
    return false;
  }
  bool compute_key(const void* /*data*/, rtps::InstanceHandle_t& /*handle*/,
                   bool /*force_md5*/) override {
    return false;
  }
};
#else
namespace rtps = eprosima::fastrtps::rtps;
const auto kOk = ReturnCode_t::RETCODE_OK;

class SerializedType : public TopicDataType {
 public:
  explicit SerializedType(const std::string& name) {
    setName(name.c_str());
    m_typeSize = kMax_bytes;
    m_isGetKeyDefined = false;
  }
  bool serialize(void* /*data*/, rtps::SerializedPayload_t* /*payload*/) override { return false; }
  bool deserialize(rtps::SerializedPayload_t* payload, void* data) override {
    static_cast<Bytes*>(data)->assign(payload->data, payload->data + payload->length);
    return true;
  }
  std::function<std::uint32_t()> getSerializedSizeProvider(void* /*data*/) override {
    return [] { return 0U; };
  }
  void* createData() override { return new Bytes; }
  void deleteData(void* data) override { delete static_cast<Bytes*>(data); }
  bool getKey(void* /*data*/, rtps::InstanceHandle_t* /*handle*/, bool /*force_md5*/) override {
    return false;
  }
};
#endif

class Printer : public DataReaderListener {
 public:
  void on_subscription_matched(DataReader* /*reader*/,
                               const SubscriptionMatchedStatus& status) override {
    if (status.current_count_change <= 0) return;
    std::puts("matched");
    std::fflush(stdout);
  }
  void on_data_available(DataReader* reader) override {
    Bytes bytes;
    SampleInfo info;
    while (reader->take_next_sample(&bytes, &info) == kOk) {
      if (!info.valid_data) continue;
      for (const unsigned char byte : bytes) std::printf("%02x", byte);
      std::puts("");
      std::fflush(stdout);
      const std::lock_guard lock(mutex_);
      ++count_;
      changed_.notify_all();
    }
  }
  void wait_for(unsigned long count) {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return count_ >= count; });
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  unsigned long count_ = 0;
};

}  // namespace

int main(int argc, char** argv) {
  if (argc != 4) return 2;
  const char* domain = std::getenv("ROS_DOMAIN_ID");
  DomainParticipantFactory* factory = DomainParticipantFactory::get_instance();
  DomainParticipantQos own = PARTICIPANT_QOS_DEFAULT;
  // rmw_fastrtps with ROS_AUTOMATIC_DISCOVERY_RANGE=LOCALHOST
  const auto transport = std::make_shared<eprosima::fastdds::rtps::UDPv4TransportDescriptor>();
  transport->interfaceWhiteList.emplace_back("127.0.0.1");
  own.transport().use_builtin_transports = false;
  own.transport().user_transports.push_back(transport);
  DomainParticipant* participant = factory->create_participant(
      domain == nullptr ? 0U : static_cast<std::uint32_t>(std::atoi(domain)), own);
  if (participant == nullptr) return 1;
  TypeSupport(new SerializedType(argv[2])).register_type(participant);
  Topic* topic = participant->create_topic(argv[1], argv[2], TOPIC_QOS_DEFAULT);
  Subscriber* subscriber = participant->create_subscriber(SUBSCRIBER_QOS_DEFAULT);
  DataReaderQos qos = DATAREADER_QOS_DEFAULT;
  qos.reliability().kind = RELIABLE_RELIABILITY_QOS;
  qos.history().depth = 10;
  // rmw_fastrtps: memory grows with the messages.
  qos.endpoint().history_memory_policy = rtps::PREALLOCATED_WITH_REALLOC_MEMORY_MODE;
  Printer printer;
  DataReader* reader = subscriber->create_datareader(topic, qos, &printer);
  if (reader == nullptr) return 1;
  printer.wait_for(std::strtoul(argv[3], nullptr, 10));
  participant->delete_contained_entities();
  factory->delete_participant(participant);
  return 0;
}
