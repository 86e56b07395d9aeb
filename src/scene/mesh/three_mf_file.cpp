
#include "scene/mesh/mesh_readers.h"
#include "scene/mesh/mesh_transform.h"

#include <Model/COM/NMR_DLLInterfaces.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <memory>
#include <vector>

namespace tumble {
namespace {

constexpr unsigned deepest = 100;  // nested components: the format forbids cycles, and people nest two or three

using Object = NMR::PLib3MFBase;
struct Release {
    void operator()(Object* object) const { NMR::lib3mf_release(object); }
};
using Owned = std::unique_ptr<Object, Release>;

void require(int result, Object* of) {
    if (result == 0) return;
    DWORD code = 0;
    LPCSTR message = nullptr;
    NMR::lib3mf_getlasterror(of, &code, &message);
    constexpr std::size_t longest = 120;  // characters of the library's own message
    throw MeshError(fmt::format("cannot be read by lib3mf: {} (error {})",
                                message != nullptr ? readable(message, longest) : "no reason given", result));
}

/// The object that a function of the library returns.
template <class Function, class... Arguments>
Owned made_by(const Function& function, Object* of, Arguments... arguments) {
    Object* object = nullptr;
    require(function(of, arguments..., &object), of);
    return Owned(object);
}

double meters(DWORD unit) {
    constexpr std::array lengths{1e-6, 1e-3, 1e-2, 0.0254, 0.3048, 1.0};  // in the order of NMR::eModelUnit
    return lengths[std::min<std::size_t>(unit, lengths.size() - 1)];
}

MeshTransform after(const MeshTransform& parent, const NMR::MODELTRANSFORM& inner) {
    Eigen::Matrix4f matrix = Eigen::Matrix4f::Identity();
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 4; ++column) matrix(row, column) = inner.m_fFields[row][column];
    return parent.then(matrix);
}

std::array<float, 3> color_of(unsigned red, unsigned green, unsigned blue) {
    return {linear_channel(float(red) / 255.0f), linear_channel(float(green) / 255.0f),
            linear_channel(float(blue) / 255.0f)};
}

class Reader {
public:
    explicit Reader(std::string_view bytes) {
        Object* model = nullptr;
        require(NMR::lib3mf_createmodel(&model), nullptr);
        model_.reset(model);
        const Owned reader = made_by(NMR::lib3mf_model_queryreader, model_.get(), "3mf");
        require(NMR::lib3mf_reader_readfrombuffer(
                    reader.get(), reinterpret_cast<BYTE*>(const_cast<char*>(bytes.data())), bytes.size()),
                reader.get());
    }

    MeshFile read() {
        DWORD unit = NMR::MODELUNIT_MILLIMETER;
        require(NMR::lib3mf_model_getunit(model_.get(), &unit), model_.get());
        Mat3 axes;
        axes << 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, -1.0, 0.0;  // the format's z axis points upward
        const MeshTransform frame{meters(unit) * axes, Vec3::Zero()};
        const Owned items = made_by(NMR::lib3mf_model_getbuilditems, model_.get());
        BOOL more = false;
        while (NMR::lib3mf_builditemiterator_movenext(items.get(), &more) == 0 && more) {
            const Owned item = made_by(NMR::lib3mf_builditemiterator_getcurrent, items.get());
            BOOL placed = false;
            NMR::MODELTRANSFORM transform{};
            require(NMR::lib3mf_builditem_hasobjecttransform(item.get(), &placed), item.get());
            if (placed) require(NMR::lib3mf_builditem_getobjecttransform(item.get(), &transform), item.get());
            add_object(made_by(NMR::lib3mf_builditem_getobjectresource, item.get()).get(),
                       placed ? after(frame, transform) : frame, 0);
        }
        mesh_.in_meters = true;
        return std::move(mesh_);
    }

private:
    void add_object(Object* object, const MeshTransform& transform, unsigned depth) {
        if (depth > deepest) throw MeshError(fmt::format("nests its components deeper than {}", deepest));
        BOOL composed = false;
        require(NMR::lib3mf_object_iscomponentsobject(object, &composed), object);
        if (!composed) return add_mesh(object, transform);
        DWORD count = 0;
        require(NMR::lib3mf_componentsobject_getcomponentcount(object, &count), object);
        for (DWORD i = 0; i < count; ++i) {
            const Owned part = made_by(NMR::lib3mf_componentsobject_getcomponent, object, i);
            BOOL placed = false;
            NMR::MODELTRANSFORM inner{};
            require(NMR::lib3mf_component_hastransform(part.get(), &placed), part.get());
            if (placed) require(NMR::lib3mf_component_gettransform(part.get(), &inner), part.get());
            add_object(made_by(NMR::lib3mf_component_getobjectresource, part.get()).get(),
                       placed ? after(transform, inner) : transform, depth + 1);
        }
    }

    void add_mesh(Object* object, const MeshTransform& transform) {
        DWORD vertices = 0, triangles = 0;
        require(NMR::lib3mf_meshobject_getvertexcount(object, &vertices), object);
        require(NMR::lib3mf_meshobject_gettrianglecount(object, &triangles), object);
        mesh_.check_more_positions(vertices);
        mesh_.check_more_triangles(triangles);
        if (triangles == 0) return;
        mesh_.begin_object();
        const auto first = std::uint32_t(mesh_.positions.size());
        for (DWORD i = 0; i < vertices; ++i) {
            NMR::MODELMESHVERTEX vertex{};
            require(NMR::lib3mf_meshobject_getvertex(object, i, &vertex), object);
            mesh_.add_position(transform.point({vertex.m_fPosition[0], vertex.m_fPosition[1], vertex.m_fPosition[2]}));
        }
        const Owned properties = made_by(NMR::lib3mf_meshobject_createpropertyhandler, object);
        for (DWORD i = 0; i < triangles; ++i) {
            NMR::MODELMESHTRIANGLE triangle{};
            require(NMR::lib3mf_meshobject_gettriangle(object, i, &triangle), object);
            std::array<MeshFile::Corner, 3> corners;
            for (std::size_t k = 0; k < 3; ++k) {
                if (triangle.m_nIndices[k] >= vertices)
                    throw MeshError(fmt::format("has a face with vertex {} of {}", triangle.m_nIndices[k], vertices));
                corners[k].position = first + triangle.m_nIndices[k];
            }
            paint(properties.get(), i, corners);
            if (transform.mirrored()) std::reverse(corners.begin(), corners.end());
            mesh_.add_triangle(corners);
        }
    }

    void paint(Object* properties, DWORD triangle, std::array<MeshFile::Corner, 3>& corners) {
        NMR::eModelPropertyType type = NMR::MODELPROPERTYTYPE_NONE;
        if (NMR::lib3mf_propertyhandler_getpropertytype(properties, triangle, &type) != 0) return;
        if (type == NMR::MODELPROPERTYTYPE_COLOR) {
            NMR::MODELMESH_TRIANGLECOLOR_SRGB colors{};
            if (NMR::lib3mf_propertyhandler_getcolor(properties, triangle, &colors) != 0) return;
            for (std::size_t k = 0; k < 3; ++k)
                corners[k].color =
                    color_of(colors.m_Colors[k].m_Red, colors.m_Colors[k].m_Green, colors.m_Colors[k].m_Blue);
            mesh_.colored = true;
        } else if (type == NMR::MODELPROPERTYTYPE_BASEMATERIALS) {
            DWORD group = 0, index = 0;
            BYTE red = 0, green = 0, blue = 0, alpha = 0;
            if (NMR::lib3mf_propertyhandler_getbasematerial(properties, triangle, &group, &index) != 0) return;
            if (group != group_id_)
                group_ = made_by(NMR::lib3mf_model_getbasematerialbyid, model_.get(), group), group_id_ = group;
            if (NMR::lib3mf_basematerial_getdisplaycolor(group_.get(), index, &red, &green, &blue, &alpha) != 0) return;
            for (MeshFile::Corner& corner : corners) corner.color = color_of(red, green, blue);
            mesh_.colored = true;
        }
    }

    Owned model_, group_;
    DWORD group_id_ = 0;  // 0 is no resource
    MeshFile mesh_;
};

}  // namespace

MeshFile read_three_mf(std::string_view bytes) { return Reader(bytes).read(); }

}  // namespace tumble
