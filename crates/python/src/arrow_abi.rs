//! The C stream interface of Arrow: its structures, and safe access to what a producer hands over.
//!
//! The layout and the rules are those of the specification (Arrow C data interface and C stream
//! interface). A producer that breaks them is beyond what any consumer can check; lengths, counts and null
//! pointers are checked.

use std::ffi::{CStr, c_char, c_int, c_void};

use pyo3::prelude::*;
use pyo3::types::PyCapsule;

/// A schema: the type and the name of an array, with its children.
#[repr(C)]
struct RawSchema {
    format: *const c_char,
    name: *const c_char,
    metadata: *const c_char,
    flags: i64,
    n_children: i64,
    children: *mut *mut RawSchema,
    dictionary: *mut RawSchema,
    release: Option<unsafe extern "C" fn(*mut RawSchema)>,
    private_data: *mut c_void,
}

/// An array: its buffers, with its children.
#[repr(C)]
struct RawArray {
    length: i64,
    null_count: i64,
    offset: i64,
    n_buffers: i64,
    n_children: i64,
    buffers: *mut *const c_void,
    children: *mut *mut RawArray,
    dictionary: *mut RawArray,
    release: Option<unsafe extern "C" fn(*mut RawArray)>,
    private_data: *mut c_void,
}

/// A stream of arrays of one schema.
#[repr(C)]
struct RawStream {
    get_schema: Option<unsafe extern "C" fn(*mut RawStream, *mut RawSchema) -> c_int>,
    get_next: Option<unsafe extern "C" fn(*mut RawStream, *mut RawArray) -> c_int>,
    get_last_error: Option<unsafe extern "C" fn(*mut RawStream) -> *const c_char>,
    release: Option<unsafe extern "C" fn(*mut RawStream)>,
    private_data: *mut c_void,
}

/// A stream of batches; released when dropped.
pub(crate) struct Stream(RawStream);

/// The schema of a batch; released when dropped.
pub(crate) struct Schema(RawSchema);

/// A batch; released when dropped.
pub(crate) struct Batch(RawArray);

/// Name, type and metadata of a column.
pub(crate) struct Field {
    pub(crate) name: String,
    /// The type, in the format strings of the interface.
    pub(crate) format: String,
    pub(crate) metadata: Vec<(String, String)>,
}

// SAFETY: the interface lets any thread call a stream, one at a time; this is its only owner, and all
// access is through `&mut`.
unsafe impl Send for Stream {}

impl Stream {
    /// Moves the stream out of its capsule.
    pub(crate) fn of_capsule(capsule: &Bound<'_, PyAny>) -> PyResult<Self> {
        let capsule = capsule.cast::<PyCapsule>()?;
        let pointer = capsule.pointer_checked(Some(c"arrow_array_stream"))?;
        let pointer = pointer.cast::<RawStream>().as_ptr();
        // SAFETY: by the protocol a capsule of this name holds a valid stream, and the interpreter is
        // attached. The copy is the owner from here on: the original is marked as released, as a move
        // of such a structure has to.
        Ok(Self(unsafe {
            let stream = pointer.read();
            (*pointer).release = None;
            stream
        }))
    }

    /// The schema of the batches.
    pub(crate) fn schema(&mut self) -> Result<Schema, String> {
        let get_schema = self.0.get_schema.filter(|_| self.0.release.is_some());
        let get_schema = get_schema.ok_or("it was read before")?;
        // SAFETY: all fields may be null or zero.
        let mut schema = Schema(unsafe { std::mem::zeroed() });
        // SAFETY: the stream is valid, as it was not released, and fills the structure.
        match unsafe { get_schema(&raw mut self.0, &raw mut schema.0) } {
            0 => Ok(schema),
            code => Err(self.error(code)),
        }
    }

    /// The next batch; `None` at the end.
    pub(crate) fn next(&mut self) -> Result<Option<Batch>, String> {
        let get_next = self.0.get_next.filter(|_| self.0.release.is_some());
        let get_next = get_next.ok_or("it was read before")?;
        // SAFETY: all fields may be null or zero.
        let mut batch = Batch(unsafe { std::mem::zeroed() });
        // SAFETY: the stream is valid, as it was not released, and fills the structure.
        match unsafe { get_next(&raw mut self.0, &raw mut batch.0) } {
            0 => Ok(Some(batch).filter(|batch| batch.0.release.is_some())),
            code => Err(self.error(code)),
        }
    }

    fn error(&mut self, code: c_int) -> String {
        let Some(get_last_error) = self.0.get_last_error else {
            return format!("error {code}");
        };
        // SAFETY: the stream is valid, and the last call failed. The text is null or valid until the next
        // call, and copied here.
        let text = unsafe {
            let text = get_last_error(&raw mut self.0);
            (!text.is_null()).then(|| CStr::from_ptr(text).to_string_lossy().into_owned())
        };
        text.unwrap_or_else(|| format!("error {code}"))
    }
}

impl Drop for Stream {
    fn drop(&mut self) {
        if let Some(release) = self.0.release {
            // SAFETY: not released before, and not used after.
            unsafe { release(&raw mut self.0) };
        }
    }
}

impl Schema {
    /// The columns of a batch; `None` if the stream is not one of batches.
    pub(crate) fn fields(&self) -> Option<Vec<Field>> {
        // SAFETY: of a schema that was not released, strings are valid or null.
        if unsafe { text(self.0.format) }? != "+s" {
            return None;
        }
        let children = usize::try_from(self.0.n_children).ok()?;
        if children > 0 && self.0.children.is_null() {
            return None;
        }
        let field = |index: usize| {
            // SAFETY: there are as many children as the schema says, each valid as long as it is.
            unsafe {
                let child = (*self.0.children.add(index)).as_ref()?;
                Some(Field {
                    name: text(child.name).unwrap_or_default(),
                    // A column with a dictionary has the type of its indices, which are no values.
                    format: match child.dictionary.is_null() {
                        true => text(child.format)?,
                        false => "dictionary".to_owned(),
                    },
                    metadata: metadata(child.metadata),
                })
            }
        };
        (0..children).map(field).collect()
    }
}

impl Drop for Schema {
    fn drop(&mut self) {
        if let Some(release) = self.0.release {
            // SAFETY: not released before, and not used after.
            unsafe { release(&raw mut self.0) };
        }
    }
}

impl Batch {
    /// Appends a column of numbers of type `T`, converted, to values; a null is NaN. `T` must be the
    /// type of the column, by its format.
    pub(crate) fn append<T: Number>(&self, column: usize, values: &mut Vec<f64>) -> Option<()> {
        let (array, first, rows) = self.column(column)?;
        if array.n_buffers < 2 || array.buffers.is_null() {
            return None;
        }
        if rows == 0 {
            return Some(());
        }
        // SAFETY: an array of numbers has a bitmap, which may be null, and a buffer of as many values as
        // offset and length together. Both live until the batch is released, which owns them. Values
        // may be unaligned only where the producer breaks the interface.
        let (bitmap, numbers) = unsafe {
            let bitmap = (*array.buffers).cast::<u8>();
            let numbers = (*array.buffers.add(1)).cast::<T>();
            if numbers.is_null() || !numbers.is_aligned() {
                return None;
            }
            (bitmap, std::slice::from_raw_parts(numbers.add(first), rows))
        };
        let is_null = |row: usize| {
            let bit = first + row;
            // SAFETY: a bitmap has a bit for each row of offset and length together.
            !bitmap.is_null() && unsafe { *bitmap.add(bit / 8) } >> (bit % 8) & 1 == 0
        };
        values.extend(numbers.iter().enumerate().map(|(row, number)| {
            if is_null(row) {
                f64::NAN
            } else {
                number.value()
            }
        }));
        Some(())
    }

    /// Number of rows.
    pub(crate) fn rows(&self) -> Option<usize> {
        usize::try_from(self.0.length).ok()
    }

    /// A column, the place of its first row in its buffers, and its number of rows.
    fn column(&self, column: usize) -> Option<(&RawArray, usize, usize)> {
        let is_there = column < usize::try_from(self.0.n_children).ok()?;
        if !is_there || self.0.children.is_null() {
            return None;
        }
        // SAFETY: there are as many children as the batch says, each valid as long as it is.
        let array = unsafe { (*self.0.children.add(column)).as_ref() }?;
        let offset = usize::try_from(self.0.offset).ok()?;
        let first = usize::try_from(array.offset).ok()?.checked_add(offset)?;
        let rows = self.rows()?;
        // The rows of the batch are within its column.
        (offset.checked_add(rows)? <= usize::try_from(array.length).ok()?).then_some(())?;
        Some((array, first, rows))
    }
}

impl Drop for Batch {
    fn drop(&mut self) {
        if let Some(release) = self.0.release {
            // SAFETY: not released before, and not used after.
            unsafe { release(&raw mut self.0) };
        }
    }
}

/// A number of any bits, as a buffer of Arrow holds it.
pub(crate) trait Number: Copy {
    /// The nearest 64-bit number.
    fn value(self) -> f64;
}

macro_rules! numbers {
    ($($kind:ty),*) => {
        $(impl Number for $kind {
            fn value(self) -> f64 {
                self as f64
            }
        })*
    };
}

numbers!(f64, f32, i8, i16, i32, i64, u8, u16, u32, u64);

/// A copy of a string.
///
/// # Safety
///
/// It is null, or a string that ends with zero.
unsafe fn text(pointer: *const c_char) -> Option<String> {
    if pointer.is_null() {
        return None;
    }
    // SAFETY: as the caller promises.
    let text = unsafe { CStr::from_ptr(pointer) };
    Some(text.to_string_lossy().into_owned())
}

/// Keys and values of metadata.
///
/// # Safety
///
/// It is null, or metadata in the form of the interface: the number of pairs, and of each key and value the
/// number of its bytes and these bytes; numbers are 32-bit integers of this machine.
unsafe fn metadata(mut pointer: *const c_char) -> Vec<(String, String)> {
    if pointer.is_null() {
        return Vec::new();
    }
    // SAFETY: as the caller promises; every read is within the form.
    unsafe {
        let pairs = usize::try_from(pointer.cast::<i32>().read_unaligned()).unwrap_or(0);
        pointer = pointer.add(4);
        let mut strings = Vec::with_capacity(2 * pairs.min(1024));
        for _ in 0..2 * pairs {
            let number = pointer.cast::<i32>().read_unaligned();
            let length = usize::try_from(number).unwrap_or(0);
            let bytes = std::slice::from_raw_parts(pointer.add(4).cast::<u8>(), length);
            strings.push(String::from_utf8_lossy(bytes).into_owned());
            pointer = pointer.add(4 + length);
        }
        let pairs = strings.chunks_exact(2);
        pairs
            .map(|pair| (pair[0].clone(), pair[1].clone()))
            .collect()
    }
}
