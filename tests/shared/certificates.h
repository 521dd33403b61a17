// Throw-away certificates for tests, signed by themselves. Link spindrift::tls_client.
#pragma once

#include <filesystem>
#include <string>

namespace spindrift::test {

struct CertificateWish {
  std::string common_name = "localhost";
  std::string alternative_names = "DNS:localhost,IP:127.0.0.1";
  long begins_after_s = -3600;
  long ends_after_s = 3600;
  std::string passphrase{};  ///< of the key; empty: none
};

/// A certificate and its private key in two PEM files.
struct CertificateFiles {
  std::string certificate;
  std::string key;
};

/// Writes NAME.pem and NAME.key into the folder, which replaces files of these names.
CertificateFiles writeCertificate(const std::filesystem::path& folder, const std::string& name,
                                  const CertificateWish& wish = {});

}  // namespace spindrift::test
