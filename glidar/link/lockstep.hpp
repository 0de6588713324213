// SPDX-FileCopyrightText: 2026 The GLIDAR developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <glidar/core/point_cloud.hpp>
#include <glidar/core/pose.hpp>
#include <glidar/link/connection_guard.hpp>
#include <glidar/link/error_log.hpp>
#include <glidar/link/socket.hpp>

#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace glidar::lockstep {

/// The lock-step protocol: a client requests measurements of a scene with poses that it specifies,
/// and receives clouds or an error message. docs/link/lockstep.md has the byte tables. All numbers
/// are little-endian.

using Bytes = std::span<const std::byte>;

inline constexpr std::uint16_t kVersion = 1;
inline constexpr std::size_t kNameBytes = 24;  ///< of a column's name, padded with zeros
inline constexpr std::uint32_t kMaxColumns = 64;
inline constexpr std::uint32_t kMaxMoments = 65536;
inline constexpr std::uint32_t kMaxObjects = 1'000'000;

/// The pose of a body and its motion during the frame: its origin has a constant velocity, and it
/// rotates at a constant rate about an axis fixed in the world.
struct Body {
  Pose world_from_body = Pose::Identity();
  Eigen::Vector3d rate_rad_s = Eigen::Vector3d::Zero();    ///< in world axes
  Eigen::Vector3d velocity_m_s = Eigen::Vector3d::Zero();  ///< of its origin, in world axes
};

/// The parameters of one measurement.
struct Moment {
  std::int64_t t_ns = 0;     ///< start of the frame
  std::uint64_t seed = 0;    ///< of all random numbers
  std::uint32_t number = 0;  ///< of the frame; scanner heads continue from frame to frame
  Body sensor;               ///< the sensor, or the rig of several sensors
  std::vector<Body> objects =
      {};  ///< in the order of the scene; empty: at their poses in the scene
};

/// Requests a description of the sensors and objects.
struct Describe {
  std::uint64_t id = 0;
};

/// Requests clouds.
struct Measure {
  std::uint64_t id = 0;       ///< returned in the reply
  std::uint32_t sensor = 0;   ///< index on the rig
  bool drop_invalid = false;  ///< omits beams without a return
  std::vector<std::string> columns;
  std::vector<Moment> moments;
};

using Request = std::variant<Describe, Measure>;

/// Throws Error with the invalid field unless all sizes, numbers and quaternions are valid. `id` is
/// set as soon as it is known, so that errors can be replied to.
Request decode_request(Bytes message, std::uint64_t& id);

std::vector<std::byte> encode(const Request& request);

/// One measured cloud.
struct CloudHead {
  std::int64_t stamp_ns = 0;
  std::uint64_t seed = 0;
  std::uint32_t number = 0;
  std::uint32_t rows = 0;
  std::uint32_t cols = 0;
  std::string frame_id;  ///< coordinate frame, at most 31 bytes
  Pose world_from_cloud = Pose::Identity();
};

/// The first part of a reply with clouds. Their numbers follow, one part for each column of the
/// first cloud, then of the second, and so on. All clouds must have the same columns.
std::vector<std::byte> encode_head(std::uint64_t id, std::span<const CloudHead> heads,
                                   const PointCloud& like);

/// A column's numbers as in memory.
Bytes bytes_of(const Column& column);

/// The first part of a reply whose second part is text: an error or a description.
enum class TextKind : std::uint16_t { error = 3, description = 4 };
std::vector<std::byte> encode_text_head(std::uint64_t id, TextKind kind);

using Clock = std::chrono::steady_clock;

/// Counts replies that are sent but not read; replies in transit share it.
struct Unread {
  std::atomic<std::int64_t> replies{0};
  std::atomic<std::int64_t> bytes{0};
};

/// A queued request.
struct Waiting {
  link::Delivered message;
  Clock::time_point since;
};

/// The queued requests of all clients, and the replies that each client has not read. Clients are
/// served in turn, one request each, however many each of them sends.
class RequestQueue {
 public:
  explicit RequestQueue(const link::Limits& limits) : limits_(limits) {}

  /// Returns the error, with the limit, if the request is not accepted; empty: it is (moved from).
  std::string add(link::Delivered& message, Clock::time_point now);
  /// The next request in turn; empty if no client without a request in progress has one. It is in
  /// progress until done() is called.
  std::optional<Waiting> next();
  /// To be called when the request in progress of this client is answered.
  void done(const std::string& client);

  /// The counter of this client's unread replies, to be increased with each reply.
  std::shared_ptr<Unread> unread_of(const link::ReturnAddress& client);
  /// Bytes of all clients together.
  [[nodiscard]] const std::shared_ptr<Unread>& all_unread() const { return all_unread_; }
  [[nodiscard]] std::int64_t waiting_bytes() const { return waiting_bytes_; }

  /// Removes clients without requests and replies, and calls `stalled` with the connection of each
  /// client that has read nothing of its replies for `timeout`. `progress` returns a number that
  /// changes when a connection receives bytes.
  void check_clients(Clock::time_point now, std::chrono::seconds timeout,
                     const std::function<std::uint64_t(const link::ConnectionId&)>& progress,
                     const std::function<void(const link::ConnectionId&)>& stalled);
  [[nodiscard]] bool has_clients() const { return !clients_.empty(); }

 private:
  struct Client {
    std::deque<Waiting> waiting;
    bool is_served = false;  ///< one of its requests is in progress
    std::shared_ptr<Unread> unread = std::make_shared<Unread>();
    link::ConnectionId connection;
    std::uint64_t progress = 0;
    Clock::time_point progress_time;
  };

  link::Limits limits_;
  std::map<std::string, Client> clients_;  ///< with requests or unread replies
  std::deque<std::string> ready_clients_;  ///< clients with queued requests and none in progress
  std::int64_t waiting_bytes_ = 0;
  std::shared_ptr<Unread> all_unread_ = std::make_shared<Unread>();
};

struct ServerOptions {
  link::Endpoint endpoint = {.host = "127.0.0.1"};
  std::optional<link::CurveKeys> curve = {};  ///< empty: not encrypted
  link::Limits limits = {};
};

/// A measured cloud of a reply.
struct CloudReply {
  CloudHead head;
  std::shared_ptr<const PointCloud> cloud;  ///< released when it is sent
};

/// The request that a reply belongs to.
struct ReplyTo {
  link::ReturnAddress from;
  std::uint64_t id = 0;
  Clock::time_point since;          ///< arrival of the request
  std::int64_t reserved_bytes = 0;  ///< for the reply
};

struct Received {
  Request request;
  ReplyTo to;
};

/// Receives requests from any number of clients, in turn, and replies in any order. Every received
/// request must be replied to or dropped once; then the client's next request is served. Used by
/// one thread.
class Server {
 public:
  /// Listens at the endpoint; throws Error if it cannot. The context and the log must outlive it.
  Server(link::Context& context, const ServerOptions& options, link::ErrorLog& errors);

  /// The next request; empty if there is none now. Never blocks. Invalid messages and those that
  /// exceed a limit get an error reply. To be called often, because it also cuts off clients that
  /// do not read.
  std::optional<Received> receive();
  /// Reserves memory for a reply, once per request. False: there is none until other clients have
  /// read their replies; then clients that read nothing for a second are cut off.
  bool reserve(ReplyTo& to, std::int64_t bytes);

  /// False if the client has left; its request is to be dropped.
  [[nodiscard]] bool is_wanted(const ReplyTo& to) const;
  /// Drops the request without a reply.
  void drop(const ReplyTo& to);

  void reply(const ReplyTo& to, std::span<const CloudReply> clouds);
  void reply_error(const ReplyTo& to, std::string_view text);
  void reply_description(const ReplyTo& to, std::string_view json);

  [[nodiscard]] const link::Socket& socket() const { return router_.socket(); }
  /// Maximum time to wait for the socket before receive() is called again.
  [[nodiscard]] std::chrono::milliseconds poll_timeout() const;

  /// Memory of queued requests, unread replies and reservations for replies.
  [[nodiscard]] std::int64_t held_bytes() const;

  struct Counts {
    std::uint64_t received = 0;
    std::uint64_t refused = 0;  ///< requests answered with an error
    std::uint64_t clouds = 0;   ///< clouds sent
  };
  [[nodiscard]] const Counts& counts() const { return counts_; }

 private:
  void collect();
  void refuse(const link::Delivered& message, std::string_view why);
  std::optional<Request> read(const Waiting& waiting, ReplyTo& to);
  void cut_off_stalled_clients(std::chrono::seconds timeout);
  void reply_text(const ReplyTo& to, TextKind kind, std::string_view text);
  void send(const ReplyTo& to, std::vector<link::Part> parts);

  link::Limits limits_;
  link::ErrorLog& errors_;
  link::Router router_;
  RequestQueue queue_;
  std::int64_t reserved_bytes_ = 0;
  Clock::time_point last_check_;
  Counts counts_;
};

}  // namespace glidar::lockstep
