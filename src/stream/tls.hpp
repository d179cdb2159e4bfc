// What a TLS client makes sure of, and how it says in words what is wrong with a certificate.
#pragma once

#include <boost/asio/ssl/context.hpp>
#include <boost/asio/ssl/verify_context.hpp>
#include <memory>
#include <string>

namespace lichtveld::stream {

// TLS 1.2 or later; certificates by the system's authorities, or by those of a PEM file alone. Throws
// std::invalid_argument for a file that cannot be read or holds no certificate.
std::shared_ptr<boost::asio::ssl::context> make_tls_context(const std::string& ca_file);

// Checks that a certificate is good and is for this host (a name or an address). After a check that failed
// `why` says whose certificate it was, what is wrong with it and what to try. To be used as a stream's verify
// callback.
class CertificateCheck {
 public:
  CertificateCheck(std::string host, std::shared_ptr<std::string> why)
      : host_(std::move(host)), why_(std::move(why)) {}

  bool operator()(bool preverified, boost::asio::ssl::verify_context& context) const;

 private:
  std::string host_;
  std::shared_ptr<std::string> why_;
};

}  // namespace lichtveld::stream
