#include "certificates.h"

#include <cstdio>
#include <memory>
#include <stdexcept>

#include <openssl/evp.h>
#include <openssl/pem.h>
#include <openssl/x509v3.h>
#include <sys/stat.h>

namespace spindrift::test {
namespace {

template <auto Free>
struct Freer {
  template <typename T>
  void operator()(T* object) const {
    Free(object);
  }
};

void must(bool succeeded, const char* what) {
  if (!succeeded) throw std::runtime_error(std::string("the test's certificate: ") + what);
}

void write(const std::string& path, const auto& write_to) {
  const std::string temporary = path + ".new";
  std::FILE* const file = std::fopen(temporary.c_str(), "w");
  must(file != nullptr, "fopen");
  const bool is_written = write_to(file) == 1;
  must(std::fclose(file) == 0 && is_written, "PEM_write");
  must(::chmod(temporary.c_str(), S_IRUSR | S_IWUSR) == 0, "chmod");
  std::filesystem::rename(temporary, path);
}

}  // namespace

CertificateFiles writeCertificate(const std::filesystem::path& folder, const std::string& name,
                                  const CertificateWish& wish) {
  const std::unique_ptr<EVP_PKEY, Freer<EVP_PKEY_free>> key(EVP_EC_gen("P-256"));
  const std::unique_ptr<X509, Freer<X509_free>> certificate(X509_new());
  must(key && certificate, "EVP_EC_gen");
  X509* const x = certificate.get();
  must(X509_set_version(x, X509_VERSION_3) == 1 && ASN1_INTEGER_set(X509_get_serialNumber(x), 1) == 1 &&
           X509_gmtime_adj(X509_getm_notBefore(x), wish.begins_after_s) != nullptr &&
           X509_gmtime_adj(X509_getm_notAfter(x), wish.ends_after_s) != nullptr && X509_set_pubkey(x, key.get()) == 1,
       "times and key");
  X509_NAME* const subject = X509_get_subject_name(x);
  const auto* common_name = reinterpret_cast<const unsigned char*>(wish.common_name.c_str());
  must(X509_NAME_add_entry_by_txt(subject, "CN", MBSTRING_ASC, common_name, -1, -1, 0) == 1 &&
           X509_set_issuer_name(x, subject) == 1,
       "names");
  const std::unique_ptr<X509_EXTENSION, Freer<X509_EXTENSION_free>> names(
      X509V3_EXT_conf_nid(nullptr, nullptr, NID_subject_alt_name, wish.alternative_names.c_str()));
  must(names && X509_add_ext(x, names.get(), -1) == 1 && X509_sign(x, key.get(), EVP_sha256()) > 0, "signature");

  const CertificateFiles out{(folder / (name + ".pem")).string(), (folder / (name + ".key")).string()};
  write(out.certificate, [&](std::FILE* file) { return PEM_write_X509(file, x); });
  write(out.key, [&](std::FILE* file) {
    const auto* pass = reinterpret_cast<const unsigned char*>(wish.passphrase.data());
    const int pass_bytes = static_cast<int>(wish.passphrase.size());
    return PEM_write_PrivateKey(file, key.get(), pass_bytes > 0 ? EVP_aes_128_cbc() : nullptr,
                                pass_bytes > 0 ? pass : nullptr, pass_bytes, nullptr, nullptr);
  });
  return out;
}

}  // namespace spindrift::test
