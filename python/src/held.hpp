// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cctype>

#include "arrays.hpp"

#include "opencv2/iib.hpp"

namespace iib_python {

//! An object of the library inside one of Python, constructed in place, so that Python's classes can extend its class.
template <typename T> struct Held
{
    cv::Ptr<T> held;
    T& operator*() const { return *held; }
    T* operator->() const { return held.get(); }
};

typedef Held<cv::Feature2D> Detector;

template <typename T> struct HeldDetector : Detector
{
    explicit HeldDetector(const cv::Ptr<T>& made) : Detector{made} {}
    T& operator*() const { return static_cast<T&>(*held); }
    T* operator->() const { return &**this; }
};

//! Constructs an object from another one, for those that Python makes without `__init__`.
template <typename Class> void sharing(Class& cls)
{
    typedef typename Class::Type Self;
    cls.def("__setstate__", [](Self& self, const Self& other) { new (&self) Self(other); });
}

//! The result of a call; a tuple of Python for a vector.
template <typename T> T result(const T& value) { return value; }
template <typename T> nb::typed<nb::tuple, T, nb::ellipsis> result(const std::vector<T>& values)
{
    return nb::borrow<nb::typed<nb::tuple, T, nb::ellipsis>>(nb::tuple(nb::cast(values)));
}

//! A method of the library without arguments.
template <typename Class, typename Owner, typename Value, typename... Extra>
void method(Class& cls, const char* name, Value (Owner::*get)() const, const char* doc, const Extra&... extra)
{
    typedef typename Class::Type Self;
    cls.def(
            name, [get](const Self& self) { return result(((*self).*get)()); }, doc, extra...);
}
template <typename Class, typename Owner>
void method(Class& cls, const char* name, void (Owner::*act)(), const char* doc)
{
    typedef typename Class::Type Self;
    cls.def(
            name, [act](Self& self) { ((*self).*act)(); }, doc);
}

//! setX and getX. @param type of opencv_iib.enums that getX returns (see opencv_iib/_methods.py); empty: Value.
//! @param argument of setX; empty: X with a small first letter.
template <typename Class, typename Owner, typename Value>
void property(Class& cls, const std::string& name, Value (Owner::*get)() const, void (Owner::*set)(Value),
        const char* doc, const std::string& type = "", std::string argument = "")
{
    typedef typename Class::Type Self;
    if (argument.empty())
        argument = char(std::tolower(name[0])) + name.substr(1);
    const std::string setter = "set" + name, getter = "get" + name, see = "See " + setter + ".";
    cls.def(
            setter.c_str(), [set](Self& self, Value value) { ((*self).*set)(value); },
            nb::arg(argument.c_str()), doc);
    if (type.empty())
        method(cls, getter.c_str(), get, see.c_str());
    else
        method(cls, getter.c_str(), get, see.c_str(),
                nb::sig(("def " + getter + "(self) -> opencv_iib.enums." + type).c_str()));
}

}  // namespace iib_python
