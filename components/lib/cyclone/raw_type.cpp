#define DDS_HAS_TYPE_DISCOVERY 1  // the Debian library is built with it; its headers expect their user to define it
#include "cyclone/raw_type.hpp"

#include <dds/ddsi/ddsi_keyhash.h>
#include <dds/ddsi/ddsi_serdata.h>
#include <dds/ddsi/ddsi_sertype.h>
#include <dds/ddsi/ddsi_xqos.h>
#include <dds/ddsi/q_radmin.h>

// After ddsi_xqos.h, whose types they use without including it.
#include <dds/ddsi/ddsi_typelib.h>
#include <dds/ddsi/ddsi_xt_impl.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <memory>
#include <utility>
#include <vector>

// An application of Cyclone may define types of its own as tables of functions. In the type defined here, a sample is
// its bytes, and all instances are one. It has no type information, so it matches every writer whose type has the same
// name.
namespace constrictor::dds {
namespace {

/// The Debian library is built with shared memory, its headers without it: the library's structures have a few more
/// fields at the end.
using Slack = std::array<void*, 8>;

struct RawType {
  ddsi_sertype base;
  Slack slack;
  std::shared_ptr<const void> type_info;  ///< of create_described_topic()
};

struct RawData {
  ddsi_serdata base;
  Slack slack;
  std::vector<std::uint8_t> bytes;
};

struct RawDataOps {
  ddsi_serdata_ops base;
  Slack slack;
};

const RawData& raw(const ddsi_serdata* data) { return *reinterpret_cast<const RawData*>(data); }

RawData* make_data(const ddsi_sertype* type, ddsi_serdata_kind kind) {
  auto data = std::make_unique<RawData>();
  ddsi_serdata_init(&data->base, type, kind);
  data->base.hash = 1;
  return data.release();
}

ddsi_serdata* from_fragments(const ddsi_sertype* type, ddsi_serdata_kind kind, const nn_rdata* fragment,
                             std::size_t size) {
  RawData* data = make_data(type, kind);
  data->bytes.resize(size);
  // Fragments may overlap.
  for (std::uint32_t offset = 0; fragment; fragment = fragment->nextfrag) {
    if (fragment->maxp1 <= offset) continue;
    const unsigned char* payload = NN_RMSG_PAYLOADOFF(fragment->rmsg, NN_RDATA_PAYLOAD_OFF(fragment));
    const std::size_t end = std::min<std::size_t>(fragment->maxp1, size);
    if (end > offset) std::memcpy(data->bytes.data() + offset, payload + offset - fragment->min, end - offset);
    offset = fragment->maxp1;
  }
  return &data->base;
}

ddsi_serdata* from_pieces(const ddsi_sertype* type, ddsi_serdata_kind kind, ddsrt_msg_iovlen_t count,
                          const ddsrt_iovec_t* pieces, std::size_t size) {
  RawData* data = make_data(type, kind);
  for (ddsrt_msg_iovlen_t i = 0; i < count; ++i) {
    const auto* bytes = static_cast<const std::uint8_t*>(pieces[i].iov_base);
    data->bytes.insert(data->bytes.end(), bytes, bytes + pieces[i].iov_len);
  }
  data->bytes.resize(size);
  return &data->base;
}

ddsi_serdata* untyped(const ddsi_serdata* sample) {
  RawData* data = make_data(sample->type, SDK_KEY);
  data->base.type = nullptr;
  return &data->base;
}

RawDataOps make_data_ops() {
  RawDataOps ops{};
  ops.base.eqkey = [](const ddsi_serdata*, const ddsi_serdata*) { return true; };
  ops.base.get_size = [](const ddsi_serdata* data) { return static_cast<std::uint32_t>(raw(data).bytes.size()); };
  ops.base.from_ser = from_fragments;
  ops.base.from_ser_iov = from_pieces;
  ops.base.from_keyhash = [](const ddsi_sertype* type, const ddsi_keyhash*) -> ddsi_serdata* {
    return &make_data(type, SDK_KEY)->base;
  };
  ops.base.from_sample = [](const ddsi_sertype*, ddsi_serdata_kind, const void*) -> ddsi_serdata* { return nullptr; };
  ops.base.to_ser = [](const ddsi_serdata* data, std::size_t offset, std::size_t size, void* buffer) {
    std::memcpy(buffer, raw(data).bytes.data() + offset, size);
  };
  ops.base.to_ser_ref = [](const ddsi_serdata* data, std::size_t offset, std::size_t size, ddsrt_iovec_t* piece) {
    piece->iov_base = const_cast<std::uint8_t*>(raw(data).bytes.data()) + offset;
    piece->iov_len = static_cast<ddsrt_iov_len_t>(size);
    return ddsi_serdata_ref(data);
  };
  ops.base.to_ser_unref = [](ddsi_serdata* data, const ddsrt_iovec_t*) { ddsi_serdata_unref(data); };
  ops.base.to_sample = [](const ddsi_serdata*, void*, void**, void*) { return false; };
  ops.base.to_untyped = untyped;
  ops.base.untyped_to_sample = [](const ddsi_sertype*, const ddsi_serdata*, void*, void**, void*) { return false; };
  ops.base.free = [](ddsi_serdata* data) { delete reinterpret_cast<RawData*>(data); };
  ops.base.print = [](const ddsi_sertype*, const ddsi_serdata*, char* text, std::size_t size) {
    if (size > 0) text[0] = '\0';
    return std::size_t{0};
  };
  ops.base.get_keyhash = [](const ddsi_serdata*, ddsi_keyhash* hash, bool) {
    std::memset(hash->value, 0, sizeof hash->value);
  };
  return ops;
}

const RawDataOps kDataOps = make_data_ops();

ddsi_sertype_ops make_type_ops() {
  ddsi_sertype_ops ops{};
  ops.version = ddsi_sertype_v0;
  ops.free = [](ddsi_sertype* type) {
    ddsi_sertype_fini(type);
    delete reinterpret_cast<RawType*>(type);
  };
  ops.zero_samples = [](const ddsi_sertype*, void*, std::size_t) {};
  ops.realloc_samples = [](void**, const ddsi_sertype*, void*, std::size_t, std::size_t) {};
  ops.free_samples = [](const ddsi_sertype*, void**, std::size_t, dds_free_op_t) {};
  ops.equal = [](const ddsi_sertype* a, const ddsi_sertype* b) { return a->typekind_no_key == b->typekind_no_key; };
  ops.hash = [](const ddsi_sertype*) { return std::uint32_t{0}; };
  return ops;
}

const ddsi_sertype_ops kTypeOps = make_type_ops();

/// What Cyclone DDS knows of the type, without the types that it contains: they are found by the type's own
/// description.
ddsi_sertype_ops make_described_type_ops() {
  static const auto info_of = [](const ddsi_sertype* type) {
    return static_cast<ddsi_typeinfo_t*>(const_cast<void*>(reinterpret_cast<const RawType*>(type)->type_info.get()));
  };
  ddsi_sertype_ops ops = make_type_ops();
  ops.equal = [](const ddsi_sertype* a, const ddsi_sertype* b) { return a == b; };
  ops.type_id = [](const ddsi_sertype* type, ddsi_typeid_kind_t kind) {
    return ddsi_typeinfo_typeid(info_of(type), kind);
  };
  ops.type_info = [](const ddsi_sertype* type) { return ddsi_typeinfo_dup(info_of(type)); };
  ops.type_map = [](const ddsi_sertype*) {
    return static_cast<ddsi_typemap_t*>(std::memset(dds_alloc(sizeof(ddsi_typemap_t)), 0, sizeof(ddsi_typemap_t)));
  };
  return ops;
}

const ddsi_sertype_ops kDescribedTypeOps = make_described_type_ops();

RawTopic make_topic(dds_entity_t participant, const std::string& name, std::unique_ptr<RawType> type) {
  type->base.allowed_data_representation = DDS_DATA_REPRESENTATION_FLAG_XCDR1 | DDS_DATA_REPRESENTATION_FLAG_XCDR2;
  ddsi_sertype* base = &type.release()->base;
  const dds_entity_t topic = dds_create_topic_sertype(participant, name.c_str(), &base, nullptr, nullptr, nullptr);
  if (topic < 0) ddsi_sertype_unref(base);
  return {Entity(topic, "dds_create_topic_sertype"), base};
}

}  // namespace

RawTopic create_raw_topic(dds_entity_t participant, const std::string& name, const std::string& type_name, bool keyed) {
  auto type = std::make_unique<RawType>();
  ddsi_sertype_init(&type->base, type_name.c_str(), &kTypeOps, &kDataOps.base, !keyed);
  return make_topic(participant, name, std::move(type));
}

RawTopic create_described_topic(dds_entity_t participant, const std::string& name, const std::string& type_name,
                                std::shared_ptr<const void> type_info) {
  auto type = std::make_unique<RawType>();
  ddsi_sertype_init(&type->base, type_name.c_str(), &kDescribedTypeOps, &kDataOps.base, true);
  type->type_info = std::move(type_info);
  return make_topic(participant, name, std::move(type));
}

ddsi_serdata* make_raw_sample(const ddsi_sertype* type, std::span<const std::uint8_t> bytes) {
  RawData* data = make_data(type, SDK_DATA);
  data->bytes.assign(bytes.begin(), bytes.end());
  return &data->base;
}

std::span<const std::uint8_t> bytes_of_raw_sample(const ddsi_serdata* sample) { return raw(sample).bytes; }

}  // namespace constrictor::dds
