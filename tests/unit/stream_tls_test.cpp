// The line to signaling over TLS, and what is said of certificates that are no good.
#include <spdlog/sinks/base_sink.h>
#include <spdlog/spdlog.h>
#include <stdlib.h>

#include <boost/asio/connect.hpp>
#include <boost/asio/read.hpp>
#include <boost/asio/ssl.hpp>
#include <boost/asio/write.hpp>
#include <filesystem>
#include <fstream>

#include "stream_room.hpp"

namespace lichtveld::stream::test {
namespace {

namespace asio = boost::asio;
namespace ssl = asio::ssl;
using asio::ip::tcp;

// An authority and certificates by it, made with the openssl command in a folder of their own.
class Certificates {
 public:
  Certificates()
      : folder_(std::filesystem::temp_directory_path() / ("lichtveld-tls-" + std::to_string(getpid()))) {
    std::filesystem::create_directories(folder_);
    run("openssl req -x509 -newkey ec -pkeyopt ec_paramgen_curve:P-256 -nodes -keyout ca.key -out ca.pem -days "
        "2 "
        "-subj '/CN=Test authority'");
    run("openssl req -x509 -newkey ec -pkeyopt ec_paramgen_curve:P-256 -nodes -keyout self.key -out self.pem "
        "-days 2 "
        "-subj '/CN=self' -addext 'subjectAltName=IP:127.0.0.1'");
    issue("good", "DNS:localhost,IP:127.0.0.1", 2);
    issue("expired", "DNS:localhost,IP:127.0.0.1", -1);
    issue("other", "DNS:room.example.org", 2);
  }
  ~Certificates() { std::filesystem::remove_all(folder_); }

  std::string file(const std::string& name) const { return (folder_ / name).string(); }

 private:
  void run(const std::string& command) const {
    if (system(("cd '" + folder_.string() + "' && " + command + " 2>openssl.log").c_str()) != 0)
      throw std::runtime_error("failed: " + command);
  }
  void issue(const std::string& name, const std::string& names, int days) const {
    std::ofstream(folder_ / (name + ".ext")) << "subjectAltName=" << names << "\n";
    run("openssl req -newkey ec -pkeyopt ec_paramgen_curve:P-256 -nodes -keyout " + name + ".key -out " + name +
        ".csr -subj '/CN=" + name + "'");
    run("openssl x509 -req -in " + name + ".csr -CA ca.pem -CAkey ca.key -CAcreateserial -days " +
        std::to_string(days) + " -out " + name + ".pem -extfile " + name + ".ext");
  }
  std::filesystem::path folder_;
};

// TLS in front of a relay, as a proxy is.
class TlsFront {
 public:
  TlsFront(unsigned short relay_port, const Certificates& certificates, const std::string& name,
           unsigned short port = 0)
      : relay_({asio::ip::address_v4::loopback(), relay_port}),
        acceptor_(io_, {asio::ip::address_v4::loopback(), port}) {
    context_.use_certificate_chain_file(certificates.file(name + ".pem"));
    context_.use_private_key_file(certificates.file(name + ".key"), ssl::context::pem);
    accept();
    thread_ = std::jthread([this] { io_.run(); });
  }
  ~TlsFront() {
    io_.stop();
    thread_.join();
  }
  unsigned short port() const { return acceptor_.local_endpoint().port(); }
  std::string url(const std::string& host = "127.0.0.1") const {
    return "wss://" + host + ":" + std::to_string(port()) + "/server";
  }

 private:
  struct Pair {
    ssl::stream<tcp::socket> outside;
    tcp::socket inside;
    std::array<char, 16384> in{}, out{};
  };
  void accept() {
    acceptor_.async_accept([this](boost::system::error_code error, tcp::socket socket) {
      if (!error) {
        auto pair = std::make_shared<Pair>(Pair{{std::move(socket), context_}, tcp::socket(io_)});
        pair->outside.async_handshake(ssl::stream_base::server, [this, pair](boost::system::error_code failed) {
          if (failed) return;
          pair->inside.connect(relay_);
          copy(pair, pair->outside, pair->inside, pair->in);
          copy(pair, pair->inside, pair->outside, pair->out);
        });
      }
      accept();
    });
  }
  template <typename From, typename To>
  void copy(std::shared_ptr<Pair> pair, From& from, To& to, std::array<char, 16384>& buffer) {
    from.async_read_some(asio::buffer(buffer),
                         [=, this, &from, &to, &buffer](boost::system::error_code error, std::size_t size) {
                           boost::system::error_code ignored;
                           if (!error) asio::write(to, asio::buffer(buffer, size), error);
                           if (!error) return copy(pair, from, to, buffer);
                           pair->outside.lowest_layer().close(ignored);
                           pair->inside.close(ignored);
                         });
  }

  asio::io_context io_;
  ssl::context context_{ssl::context::tls_server};
  tcp::endpoint relay_;
  tcp::acceptor acceptor_;
  std::jthread thread_;
};

class TlsTest : public RoomTest {
 protected:
  // What the log says from now on.
  class Sink : public spdlog::sinks::base_sink<std::mutex> {
   public:
    bool has(const std::string& text) {
      const std::lock_guard lock(mutex_);
      return said_.find(text) != std::string::npos;
    }
    std::string said() {
      const std::lock_guard lock(mutex_);
      return said_;
    }

   protected:
    void sink_it_(const spdlog::details::log_msg& message) override {
      said_.append(message.payload.data(), message.payload.size());
      said_ += '\n';
    }
    void flush_() override {}
    std::string said_;
  };
  void SetUp() override { spdlog::default_logger()->sinks().push_back(sink); }
  void TearDown() override {
    server.reset();
    spdlog::default_logger()->sinks().pop_back();
  }
  void start_at(const std::string& url, const std::string& ca) {
    auto with_tls = options();
    with_tls.signaling = url;
    with_tls.ca_file = ca.empty() ? "" : certificates().file(ca);
    server = std::make_unique<Server>(with_tls);
  }
  static Certificates& certificates() {
    static Certificates made;
    return made;
  }
  std::shared_ptr<Sink> sink = std::make_shared<Sink>();
};

TEST_F(TlsTest, RoomBehindTls) {
  TlsFront front(relay->port(), certificates(), "good");
  for (const std::string host : {"127.0.0.1", "localhost"}) {
    start_at(front.url(host), "ca.pem");
    wait_connected();
    server->publish({.bytes = map_bytes(100'000, 1), .places = rest});
    Client client(*relay);
    EXPECT_TRUE(client.wait_maps(1));
    EXPECT_TRUE(client.wait_cube(1));
    server.reset();
    ASSERT_TRUE(eventually([&] { return !relay->connected(); }));
  }
  EXPECT_FALSE(sink->has(Relay::token));
}

TEST_F(TlsTest, BadCertificatesAreNamedAndTheirRenewalIsFound) {
  const struct {
    std::string certificate, authority;
    std::vector<std::string> words;
  } cases[] = {
      {"expired", "ca.pem", {"CN = expired", "expired on ", "renew it"}},
      {"other", "ca.pem", {"CN = other", "is for other names than 127.0.0.1"}},
      {"good", "self.pem", {"CN = good", "of an authority that is not known", "--ca-file"}},
      {"good", "", {"of an authority that is not known"}},
      {"self", "ca.pem", {"CN = self", "signed by itself"}},
  };
  for (const auto& [certificate, authority, words] : cases) {
    const TlsFront front(relay->port(), certificates(), certificate);
    start_at(front.url(), authority);
    for (const std::string& word : words)
      EXPECT_TRUE(eventually([&] { return sink->has(word); })) << word << " is not in:\n" << sink->said();
    EXPECT_EQ(relay->upgrades, 0) << "nothing was said to it";
    server.reset();
  }
  auto front = std::make_unique<TlsFront>(relay->port(), certificates(), "expired");
  const auto port = front->port();
  start_at(front->url(), "ca.pem");
  ASSERT_TRUE(eventually([&] { return sink->has("expired on"); }));
  front.reset();
  front = std::make_unique<TlsFront>(relay->port(), certificates(), "good", port);
  EXPECT_TRUE(eventually([&] { return server->statistics().signaling_connected; }, 15s));
  server.reset();
}

TEST_F(TlsTest, WhereOnlyOneSideSpeaksTlsItIsSaid) {
  start_at("wss://127.0.0.1:" + std::to_string(relay->port()) + "/server", "ca.pem");
  EXPECT_TRUE(eventually([&] { return sink->has("trying again"); })) << sink->said();
  server.reset();
  const TlsFront front(relay->port(), certificates(), "good");
  auto plain = options();
  plain.signaling = "ws://127.0.0.1:" + std::to_string(front.port()) + "/server";
  server = std::make_unique<Server>(plain);
  EXPECT_TRUE(eventually([&] { return sink->has("does it speak TLS? Then the address starts with wss://"); }))
      << sink->said();
}

TEST_F(TlsTest, WhoNeverSpeaksIsGivenUp) {
  asio::io_context io;
  tcp::acceptor mute(io, {asio::ip::address_v4::loopback(), 0});
  start_at("wss://127.0.0.1:" + std::to_string(mute.local_endpoint().port()) + "/server", "ca.pem");
  EXPECT_TRUE(eventually([&] { return sink->has("trying again"); }, 8s));
  const auto start = std::chrono::steady_clock::now();
  server.reset();
  EXPECT_LT(std::chrono::steady_clock::now() - start, 1s);
}

TEST_F(TlsTest, CaFilesThatAreNoneAreRefused) {
  EXPECT_THROW(start_at("wss://127.0.0.1:1/server", "none.pem"), std::invalid_argument);
  EXPECT_THROW(start_at("wss://127.0.0.1:1/server", "ca.key"), std::invalid_argument);
  EXPECT_THROW(start_at("ws://127.0.0.1:1/server", "ca.pem"), std::invalid_argument);
}

}  // namespace
}  // namespace lichtveld::stream::test
