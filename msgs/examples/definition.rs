//! What a message type is: `cargo run -p excavator-msgs --example definition -- [TYPE]`, as in `std_msgs/msg/Header`.
//!
//! Prints its definition as bags carry it, its fields in the order of their bytes, and the hash by which ROS 2 names it.

use std::error::Error;

use excavator_msgs::{Message, OrificeCommand, TypeDescription, definitions, layout};

fn main() -> Result<(), Box<dyn Error>> {
    let name = std::env::args().nth(1).unwrap_or_else(|| OrificeCommand::TYPE_NAME.to_string());
    let schema = definitions::schema(&name).ok_or_else(|| format!("{name} is none of the types known here"))?;
    println!("{schema}");
    for field in layout::flat_fields(&name, &schema) {
        println!("{:12} {}", field.type_name, field.name);
    }
    if let Some(description) = TypeDescription::of(&name) {
        println!("{}", description.hash());
    }
    Ok(())
}
