//! The macros that declare.

/// Declares a struct of options: `pub name: Type = default`, each with a doc comment.
///
/// `=> `[`named`](crate::named)`("VALUE")` or another [`Shown`](crate::Shown) after the default changes how the command line shows the
/// value; `=> fixed` marks a field that is not an option. Attributes stay on the fields. The struct has [`Default`] and
/// [`Options`](crate::Options). With `struct Name keys Keys { … }` a struct `Keys` is declared too: the options that a file gives, and
/// their places in it.
#[macro_export]
macro_rules! options {
    (@take $head:tt $keys:tt [$($all:tt)*] $options:tt
        $(#[$($attribute:tt)*])* $visible:vis $field:ident: $type:ty = $default:expr => fixed $(, $($rest:tt)*)?
    ) => {
        $crate::options!(@take $head $keys [$($all)* { [$([$($attribute)*])*] $visible $field [$type] [$default] }] $options $($($rest)*)?);
    };
    (@take $head:tt $keys:tt [$($all:tt)*] [$($options:tt)*]
        $(#[$($attribute:tt)*])* $visible:vis $field:ident: $type:ty = $default:expr $(=> $shown:expr)? $(, $($rest:tt)*)?
    ) => {
        $crate::options!(@take $head $keys
            [$($all)* { [$([$($attribute)*])*] $visible $field [$type] [$default] }]
            [$($options)* { [$([$($attribute)*])*] $field [$type] [$default] [$($shown)?] }]
            $($($rest)*)?);
    };
    (@take [[$([$($head:tt)*])*] $visible:vis $name:ident] $keys:tt [$({
        [$([$($attribute:tt)*])*] $field_visible:vis $field:ident [$type:ty] [$default:expr]
    })*] $options:tt) => {
        $(#[$($head)*])*
        $visible struct $name {
            $($(#[$($attribute)*])* $field_visible $field: $type,)*
        }

        impl ::std::default::Default for $name {
            fn default() -> Self {
                Self { $($field: $default,)* }
            }
        }

        $crate::options!(@table $name $options);
        $crate::options!(@keys $name $keys $options);
    };
    (@table $name:ident [$({ [$([$($attribute:tt)*])*] $option:ident [$type:ty] [$default:expr] [$($shown:expr)?] })*]) => {
        impl $crate::Options for $name {
            const OPTIONS: &'static [$crate::Spec] = &[$($crate::Spec {
                name: ::std::stringify!($option),
                doc: $crate::doc!($([$($attribute)*])*),
                default: ::std::stringify!($default),
                form: <$type as $crate::Value>::FORM,
                shown: $crate::shown!($($shown)?),
            },)*];

            fn set(&mut self, name: &str, given: &$crate::Given) -> ::std::result::Result<(), ::std::string::String> {
                $(if name == ::std::stringify!($option) {
                    self.$option = <$type as $crate::Value>::read(given).ok_or_else(|| <$type as $crate::Value>::FORM.refusal(given))?;
                    return ::std::result::Result::Ok(());
                })*
                ::std::result::Result::Err($crate::unknown(name, Self::OPTIONS))
            }
        }
    };
    (@keys $name:ident [] $options:tt) => {};
    (@keys $name:ident [$visible:vis $keys:ident] [$({
        [$([$($attribute:tt)*])*] $option:ident [$type:ty] [$default:expr] [$($shown:expr)?]
    })*]) => {
        #[doc = ::std::concat!("Options of [`", ::std::stringify!($name), "`] that a file gives, with their places.")]
        #[derive(Clone, Debug, Default)]
        $visible struct $keys {
            $(#[doc = $crate::doc!($([$($attribute)*])*)] pub $option: ::std::option::Option<$crate::Spanned<$type>>,)*
        }

        impl $keys {
            /// Lays the options that are given over `target`.
            pub fn apply(&self, target: &mut $name) {
                $(if let ::std::option::Option::Some(value) = &self.$option {
                    target.$option = ::std::clone::Clone::clone(value.get_ref());
                })*
            }

            /// Place of the value of the option `name`, if it is given.
            pub fn span(&self, name: &str) -> ::std::option::Option<::std::ops::Range<usize>> {
                $(if name == ::std::stringify!($option) {
                    return self.$option.as_ref().map($crate::Spanned::span);
                })*
                ::std::option::Option::None
            }
        }

        $crate::keys!(@read $keys [$($option)*] []);
    };
    ($(#[$($attribute:tt)*])* $visible:vis struct $name:ident keys $keys_visible:vis $keys:ident { $($fields:tt)* }) => {
        $crate::options!(@take [[$([$($attribute)*])*] $visible $name] [$keys_visible $keys] [] [] $($fields)*);
    };
    ($(#[$($attribute:tt)*])* $visible:vis struct $name:ident { $($fields:tt)* }) => {
        $crate::options!(@take [[$([$($attribute)*])*] $visible $name] [] [] [] $($fields)*);
    };
}

/// Declares a struct of [`Keys`](crate::Keys): its own fields, each of a type with a default, and after `with` fields that are such structs
/// themselves and whose keys are in the same table.
#[macro_export]
macro_rules! keys {
    ($(#[$($attribute:tt)*])* $visible:vis struct $name:ident { $($(#[$($field_attribute:tt)*])* $field_visible:vis $field:ident: $type:ty),* $(,)? }
        $(with { $($(#[$($with_attribute:tt)*])* $with_visible:vis $with:ident: $with_type:ty),* $(,)? })?
    ) => {
        $(#[$($attribute)*])*
        #[derive(Default)]
        $visible struct $name {
            $($(#[$($field_attribute)*])* $field_visible $field: $type,)*
            $($($(#[$($with_attribute)*])* $with_visible $with: $with_type,)*)?
        }

        $crate::keys!(@read $name [$($field)*] [$($($with: $with_type,)*)?]);
    };
    (@read $name:ident [$($field:ident)*] [$($with:ident: $with_type:ty,)*]) => {
        impl $crate::Keys for $name {
            fn names(into: &mut ::std::vec::Vec<&'static str>) {
                into.extend([$(::std::stringify!($field)),*]);
                $(<$with_type as $crate::Keys>::names(into);)*
            }

            fn take<'de, M: ::serde::de::MapAccess<'de>>(&mut self, name: &str, map: &mut M) -> ::std::result::Result<bool, M::Error> {
                $(if name == ::std::stringify!($field) {
                    self.$field = map.next_value()?;
                    return ::std::result::Result::Ok(true);
                })*
                $(if $crate::Keys::take(&mut self.$with, name, map)? {
                    return ::std::result::Result::Ok(true);
                })*
                ::std::result::Result::Ok(false)
            }
        }

        impl<'de> ::serde::Deserialize<'de> for $name {
            fn deserialize<D: ::serde::Deserializer<'de>>(deserializer: D) -> ::std::result::Result<Self, D::Error> {
                $crate::read_keys(deserializer)
            }
        }
    };
}

/// Declares an enum whose variants are words: `Variant = "word"`, each with a doc comment. It has [`Value`](crate::Value), and `ALL` and `name`.
#[macro_export]
macro_rules! words {
    ($(#[$($attribute:tt)*])* $visible:vis enum $name:ident { $($(#[$($variant_attribute:tt)*])* $variant:ident = $word:literal),* $(,)? }) => {
        $(#[$($attribute)*])*
        $visible enum $name {
            $($(#[$($variant_attribute)*])* $variant,)*
        }

        impl $name {
            /// All of them, in the order in which they are listed.
            pub const ALL: [Self; [$($word),*].len()] = [$(Self::$variant),*];

            /// The word for it in files, on the command line and in Python.
            pub const fn name(self) -> &'static str {
                match self {
                    $(Self::$variant => $word,)*
                }
            }
        }

        impl $crate::Value for $name {
            const FORM: $crate::Form = $crate::Form::Word(&[$($crate::Word { name: $word, variant: ::std::stringify!($variant), doc: $crate::doc!($([$($variant_attribute)*])*) }),*]);

            fn read(given: &$crate::Given) -> ::std::option::Option<Self> {
                let word = given.text()?;
                Self::ALL.into_iter().find(|known| known.name() == word)
            }
        }
    };
}

/// The text of doc comments among attributes, which are given in brackets.
#[doc(hidden)]
#[macro_export]
macro_rules! doc {
    () => { "" };
    ([doc = $line:literal] $($rest:tt)*) => { ::std::concat!($line, "\n", $crate::doc!($($rest)*)) };
    ([$($other:tt)*] $($rest:tt)*) => { $crate::doc!($($rest)*) };
}

/// How a value is shown, if that is specified.
#[doc(hidden)]
#[macro_export]
macro_rules! shown {
    () => {
        ::std::option::Option::None
    };
    ($shown:expr) => {
        ::std::option::Option::Some($shown)
    };
}
