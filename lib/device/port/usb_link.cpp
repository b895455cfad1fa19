// SPDX-License-Identifier: GPL-3.0-or-later
#include "device/port/usb_link.hpp"

#include <libusb.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <utility>

#include "base/error.hpp"
#include "base/text/json.hpp"
#include "base/text/text.hpp"
#include "device/port/usb_kinds.hpp"

namespace vam::device {

namespace {

constexpr unsigned timeout_ms = 200;  // less than the guardian's patience; never 0, which would be for ever
constexpr int report_bytes = 64;
constexpr std::uint8_t vendor_request = LIBUSB_REQUEST_TYPE_VENDOR;
constexpr unsigned char report_out_endpoint = 0x01;
constexpr unsigned char report_in_endpoint = 0x81;

struct ContextCloser {
  void operator()(libusb_context* context) const { libusb_exit(context); }
};
struct HandleCloser {
  void operator()(libusb_device_handle* handle) const { libusb_close(handle); }
};
using Context = std::unique_ptr<libusb_context, ContextCloser>;
using Handle = std::unique_ptr<libusb_device_handle, HandleCloser>;

// Binary-coded decimal: 0x0106 is "1.06". Makers put the firmware's version there.
std::string release_text(int bcd) {
  std::array<char, 16> text{};
  std::snprintf(text.data(), text.size(), "%x.%02x", static_cast<unsigned>(bcd >> 8),
                static_cast<unsigned>(bcd & 0xFF));
  return text.data();
}

class LibusbLink final : public UsbLink {
 public:
  LibusbLink(Context context, Handle handle, int interface, Json about,
             const std::function<void(const std::string& name)>& named)
      : context_(std::move(context)), handle_(std::move(handle)), interface_(interface), about_(std::move(about)) {
    name_ = "usb:" + about_["usb_id"].get<std::string>() + ":" + about_["serial"].get<std::string>();
    if (named) named(name_);
    if (interface_ < 0) return;
    libusb_set_auto_detach_kernel_driver(handle_.get(), 1);
    require(libusb_claim_interface(handle_.get(), interface_), "cannot claim the interface");
  }

  ~LibusbLink() override {
    if (interface_ >= 0) libusb_release_interface(handle_.get(), interface_);
  }

  void control_out(int request, int value, int index) override {
    require(libusb_control_transfer(handle_.get(), vendor_request, static_cast<std::uint8_t>(request),
                                    static_cast<std::uint16_t>(value), static_cast<std::uint16_t>(index), nullptr, 0,
                                    timeout_ms),
            "did not accept request " + std::to_string(request));
  }

  std::string control_in(int request, int value, int index, int length) override {
    std::string data(length, '\0');
    const int count = libusb_control_transfer(
        handle_.get(), vendor_request | LIBUSB_ENDPOINT_IN, static_cast<std::uint8_t>(request),
        static_cast<std::uint16_t>(value), static_cast<std::uint16_t>(index),
        reinterpret_cast<unsigned char*>(data.data()), static_cast<std::uint16_t>(length), timeout_ms);
    require(count, "did not answer request " + std::to_string(request));
    if (count != length) {
      throw Error{Fault::protocol,
                  name_ + ": answered " + std::to_string(count) + " bytes instead of " + std::to_string(length)};
    }
    return data;
  }

  void write_report(const std::string& report) override {
    std::string bytes = report;
    bytes.resize(report_bytes, '\0');
    int sent = 0;
    require(libusb_interrupt_transfer(handle_.get(), report_out_endpoint,
                                      reinterpret_cast<unsigned char*>(bytes.data()), report_bytes, &sent, timeout_ms),
            "did not accept a report");
    if (sent != report_bytes)
      throw Error{Fault::protocol, name_ + ": accepted only " + std::to_string(sent) + " of 64 bytes"};
  }

  std::string read_report() override {
    std::string bytes(report_bytes, '\0');
    int received = 0;
    require(libusb_interrupt_transfer(handle_.get(), report_in_endpoint, reinterpret_cast<unsigned char*>(bytes.data()),
                                      report_bytes, &received, timeout_ms),
            "sent no report");
    bytes.resize(received);
    return bytes;
  }

  const std::string& name() const override { return name_; }
  Json about() const override { return about_; }

 private:
  void require(int status, const std::string& what) const {
    if (status >= 0) return;
    Fault fault = Fault::protocol;
    if (status == LIBUSB_ERROR_TIMEOUT || status == LIBUSB_ERROR_BUSY) fault = Fault::busy;
    if (status == LIBUSB_ERROR_NO_DEVICE || status == LIBUSB_ERROR_IO) fault = Fault::absent;
    throw Error{fault, name_ + ": " + what + " (" + libusb_error_name(status) + ")"};
  }

  Context context_;
  Handle handle_;
  int interface_;
  Json about_;
  std::string name_;
};

struct Listed {
  Handle handle;
  Json about;
};

// All devices of these ids that can be opened; `closed` counts those that refuse.
std::vector<Listed> search(libusb_context* context, const UsbId& id, int& closed) {
  std::vector<Listed> found;
  libusb_device** list = nullptr;
  const ssize_t count = libusb_get_device_list(context, &list);
  for (ssize_t i = 0; i < count; ++i) {
    libusb_device_descriptor descriptor{};
    if (libusb_get_device_descriptor(list[i], &descriptor) != 0 || descriptor.idVendor != id.vendor) continue;
    if (std::find(id.products.begin(), id.products.end(), descriptor.idProduct) == id.products.end()) continue;
    libusb_device_handle* opened = nullptr;
    if (libusb_open(list[i], &opened) != 0) {
      ++closed;
      continue;
    }
    Handle handle(opened);
    const std::string serial = string_of(opened, descriptor.iSerialNumber);
    if (!id.serial.empty() && serial != id.serial) continue;
    Json about{{"usb_id", ids_text(descriptor.idVendor, descriptor.idProduct)}, {"serial", serial}};
    about["maker"] = string_of(opened, descriptor.iManufacturer);
    about["model"] = string_of(opened, descriptor.iProduct);
    about["firmware"] = release_text(descriptor.bcdDevice);
    found.push_back({std::move(handle), std::move(about)});
  }
  libusb_free_device_list(list, 1);
  return found;
}

}  // namespace

std::unique_ptr<UsbLink> open_usb(const UsbId& id, int interface,
                                  const std::function<void(const std::string& name)>& named) {
  libusb_context* raw = nullptr;
  if (libusb_init(&raw) != 0) throw Error{Fault::absent, "USB: not available on this machine"};
  Context context(raw);
  int closed = 0;
  auto found = search(context.get(), id, closed);
  const std::string what =
      "usb:" + ids_text(id.vendor, id.products.front()) + (id.serial.empty() ? "" : ":" + id.serial);
  if (found.empty()) {
    throw Error{Fault::absent, what + (closed > 0 ? ": access denied; add a udev rule for vendor " +
                                                        ids_text(id.vendor, 0).substr(0, 4)
                                                  : ": no such device; check power and cable")};
  }
  if (found.size() > 1) {
    std::vector<std::string> serials;
    for (const auto& one : found) serials.push_back(one.about["serial"]);
    throw Error{Fault::usage, what + ": found " + std::to_string(found.size()) +
                                  "; select one by serial number: " + join(serials, ", ")};
  }
  return std::make_unique<LibusbLink>(std::move(context), std::move(found.front().handle), interface,
                                      std::move(found.front().about), named);
}

}  // namespace vam::device
