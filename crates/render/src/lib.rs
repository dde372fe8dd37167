//! Light transport: a Scene and a Camera to a Frame with every layer.
