#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace drake_haptics {

/// A UDP socket to one peer. What others send is dropped by the system. No call
/// but the constructor waits.
class UdpSocket {
 public:
  /// Opens a socket on a free port. Of the addresses of a name the first of
  /// IPv4 is taken, else of IPv6. Waits for the name to be found.
  /// @throws std::runtime_error if there is no such host, or no socket.
  UdpSocket(const std::string& host, std::uint16_t port);
  ~UdpSocket();
  UdpSocket(const UdpSocket&) = delete;
  UdpSocket& operator=(const UdpSocket&) = delete;

  /// Sends one packet; if the system cannot now, it is lost as on the way.
  void Send(std::span<const unsigned char> packet);

  /// Receives one packet, cut to the size of the buffer.
  /// @returns its size; −1 if none is waiting.
  std::ptrdiff_t Receive(std::span<unsigned char> buffer);

  /// Waits until a packet is there or `timeout` s are over, rounded up to ms.
  void Wait(double timeout) const;

  /// Our own port.
  std::uint16_t local_port() const;

 private:
  int descriptor_ = -1;
};

}  // namespace drake_haptics
