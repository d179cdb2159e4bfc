#include "tls.hpp"

#include <openssl/bio.h>
#include <openssl/x509v3.h>

#include <boost/asio/ssl/host_name_verification.hpp>
#include <stdexcept>

namespace lichtveld::stream {

namespace ssl = boost::asio::ssl;

namespace {

// What a function of OpenSSL prints.
template <typename Print>
std::string printed(Print print) {
  const std::unique_ptr<BIO, decltype(&BIO_free)> out(BIO_new(BIO_s_mem()), &BIO_free);
  print(out.get());
  char* text = nullptr;
  const long size = BIO_get_mem_data(out.get(), &text);
  return {text, static_cast<std::size_t>(size)};
}

std::string time_of(const ASN1_TIME* time) {
  return printed([&](BIO* out) { ASN1_TIME_print(out, time); });
}

std::string what_is_wrong(int error, const X509* certificate) {
  switch (error) {
    case X509_V_ERR_CERT_HAS_EXPIRED:
      return "expired on " + time_of(X509_get0_notAfter(certificate)) + ": renew it";
    case X509_V_ERR_CERT_NOT_YET_VALID:
      return "is only good from " + time_of(X509_get0_notBefore(certificate)) +
             " on: look at the clocks of both machines";
    case X509_V_ERR_DEPTH_ZERO_SELF_SIGNED_CERT:
      return "is signed by itself: give it to --ca-file if it is yours";
    case X509_V_ERR_SELF_SIGNED_CERT_IN_CHAIN:
    case X509_V_ERR_UNABLE_TO_GET_ISSUER_CERT:
    case X509_V_ERR_UNABLE_TO_GET_ISSUER_CERT_LOCALLY:
    case X509_V_ERR_UNABLE_TO_VERIFY_LEAF_SIGNATURE:
      return "is of an authority that is not known: give that one's certificate to --ca-file if it is yours, "
             "or let "
             "signaling send the whole chain";
    default:
      return std::string("is not good: ") + X509_verify_cert_error_string(error);
  }
}

}  // namespace

std::shared_ptr<ssl::context> make_tls_context(const std::string& ca_file) {
  auto context = std::make_shared<ssl::context>(ssl::context::tls_client);
  SSL_CTX_set_min_proto_version(context->native_handle(), TLS1_2_VERSION);
  context->set_verify_mode(ssl::verify_peer);
  boost::system::error_code error;
  if (ca_file.empty())
    context->set_default_verify_paths();
  else
    context->load_verify_file(ca_file, error);
  if (error)
    throw std::invalid_argument("--ca-file " + ca_file +
                                ": no certificate can be read from it; give a PEM file");
  return context;
}

bool CertificateCheck::operator()(bool preverified, ssl::verify_context& context) const {
  const X509* certificate = X509_STORE_CTX_get_current_cert(context.native_handle());
  const int error = X509_STORE_CTX_get_error(context.native_handle());
  const std::string whose = !certificate ? "its certificate " : printed([&](BIO* out) {
    BIO_puts(out, "its certificate (");
    X509_NAME_print_ex(out, X509_get_subject_name(certificate), 0, XN_FLAG_ONELINE & ~ASN1_STRFLGS_ESC_MSB);
    BIO_puts(out, ") ");
  });
  if (!preverified) {
    *why_ = whose + what_is_wrong(error, certificate);
    return false;
  }
  if (ssl::host_name_verification(host_)(preverified, context)) return true;
  *why_ = whose + "is for other names than " + host_ + ": call signaling by a name that is in it";
  return false;
}

}  // namespace lichtveld::stream
