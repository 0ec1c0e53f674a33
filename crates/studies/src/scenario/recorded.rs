//! The recorded log: columns, counts and axes.

use schuler_imu::Unit;

use super::{
    de::At,
    document::{Document, Spot},
    quantity::Range,
    schema::Title,
    written,
};
use crate::{
    Diagnostic,
    log::{AxisMap, ColumnRef, Columns, Content, LogSpec, Scale, TimeColumn},
};

pub(super) fn content(content: written::Content) -> Content {
    match content {
        written::Content::Increments => Content::Increments,
        written::Content::Rates => Content::Rates,
    }
}

fn column(title: &Title) -> ColumnRef {
    match title {
        Title::Name(name) => ColumnRef::Name(name.clone()),
        Title::Number(number) => ColumnRef::Number(*number as usize),
    }
}

impl Document {
    pub(super) fn log(&self, w: &written::Log) -> Result<LogSpec, Diagnostic> {
        let content = content(w.content);
        let per = match content {
            Content::Increments => Unit::SECOND,
            Content::Rates => Unit::ONE,
        };
        let time =
            w.scale.time.as_ref().map(|t| self.quantity(t, Unit::SECOND, Range::Positive)).transpose()?;
        let time_column = |title| TimeColumn { column: column(title), scale: time.unwrap_or(1.0) };
        Ok(LogSpec {
            file: w.file.value.clone(),
            source: w.source.clone().unwrap_or_default(),
            rate: self.quantity(&w.rate, Unit::HERTZ, Range::Positive)?,
            content,
            columns: Columns {
                time: w.columns.time.as_ref().map(time_column),
                gyro: w.columns.gyro.each_ref().map(column),
                accel: w.columns.accel.each_ref().map(column),
            },
            scale: Scale {
                gyro: self.each_axis(&w.scale.gyro, Unit::RATE * per, Range::Any)?,
                accel: self.each_axis(&w.scale.accel, Unit::FORCE * per, Range::Any)?,
            },
            axes: w.axes.as_ref().map_or(Ok(AxisMap::IDENTITY), |axes| self.axes(axes))?,
            stationary: w.stationary.unwrap_or(false),
        })
    }

    fn axes(&self, axes: &At<[At<String>; 3]>) -> Result<AxisMap, Diagnostic> {
        AxisMap::parse(axes.value.each_ref().map(|word| word.value.as_str())).map_err(|e| {
            self.diagnostic(Spot::Node(axes.node), e.to_string())
                .expected("the sensor axes that point forward, right and down")
                .example("[y, x, -z] for a sensor with x right, y forward, z up")
        })
    }
}
