//! Operations by their names in the file.

macro_rules! operations {
    ($(#[$doc:meta])* $name:ident { $($(#[$variant_doc:meta])* $variant:ident = $text:literal),* $(,)? }) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        #[non_exhaustive]
        pub enum $name { $($(#[$variant_doc])* $variant),* }

        impl $name {
            /// The names in program files.
            pub const NAMES: &[&str] = &[$($text),*];

            /// The operation of a name.
            #[must_use]
            pub fn from_name(name: &str) -> Option<Self> {
                match name {
                    $($text => Some(Self::$variant),)*
                    _ => None,
                }
            }
        }
    };
}

operations! {
    /// Functions of one scalar.
    UnaryOperation {
        /// The operand itself.
        Copy = "copy",
        /// -x.
        Negate = "neg",
        /// x x.
        Square = "sq",
        /// x + x.
        Twice = "twice",
        /// 1 / x.
        Reciprocal = "inv",
        /// Square root.
        Sqrt = "sqrt",
        /// Natural exponential.
        Exp = "exp",
        /// Natural logarithm.
        Log = "log",
        /// Sine.
        Sin = "sin",
        /// Cosine.
        Cos = "cos",
        /// Tangent.
        Tan = "tan",
        /// Inverse sine.
        Asin = "asin",
        /// Inverse cosine.
        Acos = "acos",
        /// Inverse tangent.
        Atan = "atan",
        /// Hyperbolic sine.
        Sinh = "sinh",
        /// Hyperbolic cosine.
        Cosh = "cosh",
        /// Hyperbolic tangent.
        Tanh = "tanh",
        /// Inverse hyperbolic sine.
        Asinh = "asinh",
        /// Inverse hyperbolic cosine.
        Acosh = "acosh",
        /// Inverse hyperbolic tangent.
        Atanh = "atanh",
        /// Natural exponential less one.
        Expm1 = "expm1",
        /// Natural logarithm of one plus x.
        Log1p = "log1p",
        /// Error function.
        Erf = "erf",
        /// Inverse of the error function.
        ErfInv = "erfinv",
        /// Largest integer not above x.
        Floor = "floor",
        /// Smallest integer not below x.
        Ceil = "ceil",
        /// Absolute value.
        Abs = "abs",
        /// -1, 0 or 1.
        Sign = "sign",
        /// 1 where x is 0, else 0.
        Not = "not",
    }
}

operations! {
    /// Functions of two scalars.
    BinaryOperation {
        /// x + y.
        Add = "add",
        /// x - y.
        Sub = "sub",
        /// x y.
        Mul = "mul",
        /// x / y.
        Div = "div",
        /// x to the power y.
        Pow = "pow",
        /// Angle of the point (y, x), x being the first operand.
        Atan2 = "atan2",
        /// x less the multiple of y next to it towards zero.
        Fmod = "fmod",
        /// x less the multiple of y next to it.
        Remainder = "remainder",
        /// Root of x x + y y.
        Hypot = "hypot",
        /// x with the sign of y.
        CopySign = "copysign",
        /// The smaller.
        Min = "min",
        /// The larger.
        Max = "max",
        /// 1 where x < y, else 0.
        Less = "lt",
        /// 1 where x <= y, else 0.
        LessOrEqual = "le",
        /// 1 where x = y, else 0.
        Equal = "eq",
        /// 1 where x and y differ, else 0.
        NotEqual = "ne",
        /// 1 where neither is 0, else 0.
        And = "and",
        /// 1 where one is not 0, else 0.
        Or = "or",
        /// y where x is not 0, else 0.
        IfElseZero = "if_else_zero",
    }
}

/// First word of an instruction.
#[derive(Clone, Copy)]
pub(super) enum Name {
    Input,
    Output,
    Constant,
    Call,
    Unary(UnaryOperation),
    Binary(BinaryOperation),
}

impl Name {
    pub(super) fn from_text(text: &str) -> Option<Self> {
        match text {
            "input" => Some(Self::Input),
            "output" => Some(Self::Output),
            "const" => Some(Self::Constant),
            "call" => Some(Self::Call),
            _ => UnaryOperation::from_name(text)
                .map(Self::Unary)
                .or_else(|| BinaryOperation::from_name(text).map(Self::Binary)),
        }
    }
}
