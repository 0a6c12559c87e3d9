//! Exposes columns of Rust as NumPy arrays, without a copy. Only this file of the crate contains `unsafe` code.

use numpy::ndarray::ArrayView1;
use numpy::{PyArray1, PyArrayMethods};
use pyo3::pyclass::boolean_struct::True;
use pyo3::{Bound, PyClass, PyTypeInfo};

/// The column that `pick` finds in `owner`, as a read-only array. The array keeps the owner alive.
pub fn view<'py, T>(
    owner: &Bound<'py, T>,
    pick: impl for<'a> FnOnce(&'a T) -> Option<&'a [f64]>,
) -> Option<Bound<'py, PyArray1<f64>>>
where
    T: PyClass<Frozen = True> + PyTypeInfo + Sync,
{
    let column = ArrayView1::from(pick(owner.get())?);
    // SAFETY: the column is part of the owner, which is frozen: it neither moves nor changes while it lives, and the array
    // holds a reference to it. The array is made read-only before any other code can access it, so nothing writes through it.
    #[allow(unsafe_code)]
    let array = unsafe { PyArray1::borrow_from_array(&column, owner.clone().into_any()) };
    drop(array.readwrite().make_nonwriteable());
    Some(array)
}
